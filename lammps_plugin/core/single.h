// The passes over a fluid in single precision: as those of double.h, four particles or more at a time.
// Sums and turns are made in double; what a cell's turn does to particles is rounded to single.

#pragma once

#include "collision.h"
#include "streaming.h"

#include <cstring>

namespace mpc {

using Four = float __attribute__((vector_size(16)));
using FourDoubles = double __attribute__((vector_size(32)));

constexpr double MOST_CELLS = 3900;      // of a process along an axis: 2^32 places, less two flights
constexpr double LONGEST_FLIGHT = 64;    // cells

inline Four load_four(const float *from)
{
  Four four;
  std::memcpy(&four, from, sizeof four);
  return four;
}

inline void store_four(float *to, const Four &four) { std::memcpy(to, &four, sizeof four); }

// Rows become columns.
inline void transpose(Four &a, Four &b, Four &c, Four &d)
{
  const Four ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Four ba = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Four cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Four dc = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
  c = __builtin_shufflevector(ba, dc, 0, 1, 4, 5);
  d = __builtin_shufflevector(ba, dc, 2, 3, 6, 7);
}

constexpr std::uint64_t FINER = (1 << 29) - 1;    // the digits that a single number lacks
constexpr std::uint64_t NEAREST = 1 << 28;        // half of the last that it has

// A double as a single number: the nearest; or, of random digits, one of the two next to it, so that
// on average it is the double.
inline float rounded(double value, std::uint64_t digits)
{
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  bits = (bits + digits) & ~FINER;
  std::memcpy(&value, &bits, sizeof bits);
  return static_cast<float>(value);
}

// A turn, rounded. In two dimensions offset, cosine and sine, as its matrix is a rotation times a
// number; in three each row of the matrix with its component of the offset. Of a matrix that is
// always the same, the nearest would multiply all energies by the same number, up to 3e-8 from 1, at
// each collision: so it is rounded by random digits.
template <int D> struct SingleTurn {
  Four row[D == 2 ? 1 : 3];

  SingleTurn() = default;
  SingleTurn(const Turn<D> &turn, std::uint64_t digits)
  {
    for (int a = 0; a < D; ++a) {
      if constexpr (D == 2) {
        row[0][a] = static_cast<float>(turn.offset[a]);
        row[0][2 + a] = rounded(turn.column[0][a], digits);
      } else {
        for (int b = 0; b < D; ++b) row[a][b] = rounded(turn.column[b][a], digits);
        row[a][3] = static_cast<float>(turn.offset[a]);
      }
    }
  }

  Vector<D> apply(const Vector<D> &v) const
  {
    if constexpr (D == 2) {
      const double x = row[0][0], y = row[0][1], cosine = row[0][2], sine = row[0][3];
      return {x + cosine * v[0] - sine * v[1], y + sine * v[0] + cosine * v[1]};
    } else {
      Vector<D> turned;
      for (int a = 0; a < D; ++a)
        turned[a] = row[a][3] + (1.0 * row[a][0] * v[0] + 1.0 * row[a][1] * v[1] +
                                 1.0 * row[a][2] * v[2]);
      return turned;
    }
  }
};

// Of four particles.
inline void apply(const SingleTurn<2> *const (&of)[4], Four (&v)[2])
{
  Four x = of[0]->row[0], y = of[1]->row[0], cosine = of[2]->row[0], sine = of[3]->row[0];
  transpose(x, y, cosine, sine);
  const Four turned = x + (cosine * v[0] - sine * v[1]);
  v[1] = y + (sine * v[0] + cosine * v[1]);
  v[0] = turned;
}

inline void apply(const SingleTurn<3> *const (&of)[4], Four (&v)[3])
{
  Four turned[3];
  for (int a = 0; a < 3; ++a) {
    Four x = of[0]->row[a], y = of[1]->row[a], z = of[2]->row[a], offset = of[3]->row[a];
    transpose(x, y, z, offset);
    turned[a] = offset + (x * v[0] + y * v[1] + z * v[2]);
  }
  std::copy(turned, turned + 3, v);
}

// Ask for what four particles a few further on need of their cells.
template <class Value>
inline __attribute__((always_inline)) void prefetch_four(const Value *of_cells,
                                                         const std::int32_t *cell)
{
  for (int k = 0; k < 4; ++k) {
    const auto *value = reinterpret_cast<const char *>(of_cells + cell[k]);
    __builtin_prefetch(value, 1);
    if (alignof(Value) < sizeof(Value)) __builtin_prefetch(value + sizeof(Value) - 1, 1);
  }
}

constexpr int AHEAD_OF_FOUR = 96;    // particles

// Velocities after the turns of their cells.
template <int D>
void turn(Fluid<D, float> &fluid, const Array<SingleTurn<D>> &of_cells, int begin, int end)
{
  const auto *turns = of_cells.data();
  const auto *cell = fluid.cell.data();
  std::array<float *, D> v;
  for (int a = 0; a < D; ++a) v[a] = fluid.v[a].data();
  const int ahead = fluid.size() - AHEAD_OF_FOUR - 4;
  int i = begin;
  for (; i + 4 <= end; i += 4) {
    if (D == 3 && i < ahead) prefetch_four(turns, cell + i + AHEAD_OF_FOUR);
    const SingleTurn<D> *const of[4] = {turns + cell[i], turns + cell[i + 1], turns + cell[i + 2],
                                        turns + cell[i + 3]};
    Four of_four[D];
    for (int a = 0; a < D; ++a) of_four[a] = load_four(v[a] + i);
    apply(of, of_four);
    for (int a = 0; a < D; ++a) store_four(v[a] + i, of_four[a]);
  }
  for (; i < end; ++i) {
    const auto *mine = turns + cell[i];
    const SingleTurn<D> *const of[4] = {mine, mine, mine, mine};
    Four alone[D];
    for (int a = 0; a < D; ++a) alone[a] = Four{} + v[a][i];
    apply(of, alone);
    for (int a = 0; a < D; ++a) v[a][i] = alone[a][0];
  }
}

// Adds four particles to the sums of their cells.
template <int D> class AddFour {
 public:
  AddFour(const Fluid<D, float> &fluid, CellSums<D> &sums)
    : cell_(fluid.cell.data()), sums_(sums.of.data()),
      squares_(sums.squares.empty() ? nullptr : sums.squares.data()),
      ahead_(fluid.size() - AHEAD_OF_FOUR - 4)
  {
    for (int a = 0; a < D; ++a) v_[a] = fluid.v[a].data();
  }

  void operator()(int first) const
  {
    if (D == 3 && first < ahead_) {
      prefetch_four(sums_, cell_ + first + AHEAD_OF_FOUR);
      if (squares_) prefetch_four(squares_, cell_ + first + AHEAD_OF_FOUR);
    }
    Four x = load_four(v_[0] + first), y = load_four(v_[1] + first), z, ones = {1, 1, 1, 1};
    Four square = x * x + y * y;
    if constexpr (D == 3) {
      z = load_four(v_[2] + first);
      square += z * z;
    } else {
      z = square;
    }
    transpose(x, y, z, ones);
    const Four of_particle[4] = {x, y, z, ones};
    for (int k = 0; k < 4; ++k) {
      const int cell = cell_[first + k];
      FourDoubles total;
      static_assert(sizeof(CellSum<D>) == sizeof total);
      std::memcpy(&total, sums_ + cell, sizeof total);
      total += __builtin_convertvector(of_particle[k], FourDoubles);
      std::memcpy(static_cast<void *>(sums_ + cell), &total, sizeof total);
      if (D == 3 && squares_) squares_[cell] += square[k];
    }
  }

 private:
  const std::int32_t *cell_;
  CellSum<D> *sums_;
  double *squares_;    // or none
  std::array<const float *, D> v_;
  int ahead_;
};

// The grid's shift at a place, for rows to be found in whole numbers.
template <int D> void round_shift(Grid<D> &grid)
{
  for (double &shift : grid.shift) shift = std::floor(shift * PLACES) / PLACES;
}

// The places of a process's cells.
template <int D> std::array<Places, D> places_of(const Grid<D> &grid)
{
  std::array<Places, D> places;
  for (int a = 0; a < D; ++a) {
    if (grid.extent(a) > MOST_CELLS)
      throw Fault("precision single: " + std::to_string(grid.extent(a)) + " cells along " + "xyz"[a] +
                  " on a process: must be at most " + std::to_string(static_cast<int>(MOST_CELLS)));
    const double length = grid.edge / PLACES, middle = 0.5 * (grid.lower[a] + grid.upper[a]) * grid.edge;
    auto &along = places[a] = {middle, length, grid.periodic[a] ? grid.box[a] : 0.0, INT32_MIN,
                               INT32_MAX};
    if (grid.periodic[a]) continue;
    along.first = static_cast<std::int32_t>(
        std::max<double>(std::ceil(-middle / length), INT32_MIN));
    along.last = static_cast<std::int32_t>(
        std::min(std::floor((grid.box[a] - middle) / length), 1.0 * INT32_MAX));
  }
  return places;
}

// A velocity that a field adds in an interval is rounded in each particle alike, where it is small
// beside the last digit of the particles' velocities. So what is added goes up and down by such a
// digit, that of 16 thermal speeds, from interval to interval, and is right on average for all.
inline double last_digit(double thermal_speed)
{
  return std::exp2(std::ceil(std::log2(16 * thermal_speed)) - 24);
}

inline double dithered(double kick, double digit, std::uint64_t interval)
{
  constexpr double golden = 0.6180339887498949;
  const double part = interval * golden - std::floor(interval * golden);
  return kick == 0 ? 0 : kick + digit * (part - 0.5);
}

// Whole places, the nearest; none for what is too far or not a number, which find_cells() tells.
inline std::int32_t nearest(float places)
{
  constexpr float most = LONGEST_FLIGHT * PLACES;
  const float near = std::abs(places) < most ? places : 0.0f;
  return static_cast<std::int32_t>(near + std::copysign(0.5f, near));
}

// Move particles begin ... end - 1 to the end of the interval as stream(), to the nearest places.
template <int D>
void fly(Fluid<D, float> &fluid, const Grid<D> &grid, const Vector<D> &field, const Vector<D> &kick,
         double time, const Walls<D> *walls, int begin, int end)
{
  static thread_local std::vector<std::pair<int, std::array<Vector<D>, 2>>> bounced;
  bounced.clear();
  const auto by_velocity = static_cast<float>(time * PLACES / grid.edge);
  std::array<float, D> by_field;
  for (int a = 0; a < D; ++a)
    by_field[a] = static_cast<float>(0.5 * time * field[a] * time * PLACES / grid.edge);
  const auto target = [&](int axis, int i) {
    return fluid.x[axis][i] + nearest(fluid.v[axis][i] * by_velocity + by_field[axis]);
  };
  if (walls) {
    int crossing = 0;
    for (int a : walls->axes()) {
      const std::int32_t first = fluid.places[a].first, last = fluid.places[a].last;
      const std::int32_t *__restrict y = fluid.x[a].data();
      const float *__restrict v = fluid.v[a].data();
      const float fallen = by_field[a];
      for (int i = begin; i < end; ++i) {
        const std::int32_t at = y[i] + nearest(v[i] * by_velocity + fallen);
        crossing += (at < first) | (at > last);
      }
    }
    for (int i = begin; crossing > 0; ++i) {
      int faces = 0;
      for (int a : walls->axes()) {
        const std::int32_t at = target(a, i);
        faces += (at < fluid.places[a].first) | (at > fluid.places[a].last);
      }
      if (faces == 0) continue;
      crossing -= faces;
      auto [id, x, v] = fluid.particle(i);
      if (!fly_between<D>(*walls, x, v, field, time)) throw TooManyBounces{i};
      bounced.push_back({i, {x, v}});
    }
  }
  for (int a = 0; a < D; ++a) {
    std::int32_t *__restrict x = fluid.x[a].data();
    float *__restrict v = fluid.v[a].data();
    const float fallen = by_field[a], added = static_cast<float>(kick[a]);
    for (int i = begin; i < end; ++i) {
      x[i] += nearest(v[i] * by_velocity + fallen);
      v[i] += added;
    }
  }
  for (const auto &[i, state] : bounced)
    for (int a = 0; a < D; ++a) {
      fluid.set_position(a, i, state[0][a]);
      fluid.v[a][i] = static_cast<float>(state[1][a]);
    }
}

// Wrap and find the cells; whoever is in none of this process's, or has flown too far, is a stray.
template <int D>
void find_cells(Fluid<D, float> &fluid, const Grid<D> &grid, double time, int begin, int end,
                std::int32_t stray)
{
  std::int32_t *__restrict cell = fluid.cell.data();
  const auto fastest = static_cast<float>(LONGEST_FLIGHT * grid.edge / time);
  std::int32_t stride = 1;
  for (int a = 0; a < D; ++a) {
    std::int32_t *__restrict x = fluid.x[a].data();
    const float *__restrict v = fluid.v[a].data();
    const std::uint32_t rows = grid.extent(a);
    const bool whole = grid.periodic[a] && grid.extent(a) == grid.shape[a];
    const std::uint32_t size = rows << PLACE_BITS;
    const auto high = static_cast<std::int32_t>(size / 2), low = -high;
    const auto shift = static_cast<std::uint32_t>(grid.shift[a] * PLACES);
    for (int i = begin; i < end; ++i) {
      std::int32_t at = x[i];
      if (whole) {
        const auto places = static_cast<std::uint32_t>(at);
        at = at < low ? static_cast<std::int32_t>(places + size)
            : at >= high ? static_cast<std::int32_t>(places - size) : at;
        x[i] = at;
      }
      std::uint32_t row = (static_cast<std::uint32_t>(at) - low + shift) >> PLACE_BITS;
      if (whole) row = row < rows ? row : row - rows;
      const bool mine = (row < rows) & (std::abs(v[i]) < fastest);
      const std::int32_t before = a == 0 ? 0 : cell[i];
      cell[i] = mine & (before >= 0) ? before + stride * static_cast<std::int32_t>(row) : stray;
    }
    stride *= static_cast<std::int32_t>(rows);
  }
}

}    // namespace mpc
