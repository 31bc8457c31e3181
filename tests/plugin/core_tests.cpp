// Tests of the core, which needs neither LAMMPS nor MPI: the smallest cases that a reader can do by
// hand. Run by test_core.py, also under the address and undefined-behaviour sanitizers.

#include "cell_coupling.h"
#include "force_coupling.h"
#include "no_slip_walls.h"
#include "profile.h"
#include "reflection_coupling.h"
#include "solver.h"

#include <algorithm>
#include <cfloat>
#include <cstdio>
#include <numeric>
#include <utility>

using namespace mpc;

namespace {

int failures = 0;

void check(bool holds, const char *what, int line)
{
  if (holds) return;
  std::printf("line %d: %s\n", line, what);
  ++failures;
}
#define CHECK(condition) check(condition, #condition, __LINE__)

bool close(double a, double b, double tolerance = 1e-14)
{
  return std::abs(a - b) <= tolerance;
}

template <int D> Method<D> method(double interval = 0.1)
{
  const Rotation rotation(M_PI / 2, Axes::Coordinate);
  return {1, interval, {}, rotation, true, {}, {}, {}, {}};
}

// 4 cells along each axis, with walls across y or without.
template <int D> Grid<D> box_grid(bool walls)
{
  Vector<D> size;
  size.fill(4);
  std::array<bool, D> periodic;
  periodic.fill(true);
  periodic[1] = !walls;
  return {size, periodic, 1.0};
}

// A fluid of given particles in such a box.
template <int D> struct Box {
  Processes alone;
  Grid<D> grid;
  std::unique_ptr<Solver<D>> solver;

  explicit Box(std::vector<Particle<D>> particles, Method<D> how = method<D>())
    : grid(box_grid<D>(how.walls != nullptr))
  {
    solver = std::make_unique<Solver<D>>(grid, std::move(how), alone);
    solver->reset(0, grid.lower, grid.upper);
    for (const auto &particle : particles) solver->add(particle);
    solver->count();
  }

  void collide(const std::vector<Colloid<D>> &colloids = {})
  {
    solver->begin_interval(colloids, 0.0);
    solver->end_interval(colloids);
    solver->turn();
  }
};

// What numpy.random.Philox(key, counter).random_raw(4) gives; it adds 1 to its counter first.
void philox_known_answers()
{
  const auto zero = philox({1, 0, 0, 0}, 0, 0);
  CHECK((zero == Words{0x2f4ba6408e4d89bu, 0x3dd62b0b9ca8c5b2u, 0x1c8667a55d902e79u, 0x907d7a052fd5b4dcu}));
  const auto some = philox({5, 7, 2, 0}, 12345, 3);
  CHECK((some == Words{0xdab8696e121e3275u, 0x20dddbf48c851d77u, 0x6a4824bedd594ef1u, 0xb578f38137e13309u}));
  const CounterRandom random{12345, 7};
  CHECK(random.words(Stream::Wall, 4, 2) == some);
  CHECK(uniform(~std::uint64_t{0}) < 1);
  CHECK(uniform(std::uint64_t{1} << 63) == 0.5);
}

// Momentum (2, 6), mean (0.5, 1.5): by 90 degrees, relative (x, y) becomes (-y, x) or (y, -x).
void four_particles_in_a_cell()
{
  auto how = method<2>(0.0);
  how.shifted = false;
  Box<2> box({{0, {1.1, 2.1}, {1, 0}},
              {1, {1.2, 2.2}, {-1, 2}},
              {2, {1.3, 2.3}, {2, 3}},
              {3, {1.4, 2.4}, {0, 1}},
              {4, {3.5, 3.5}, {7, -2}}},
             std::move(how));
  box.collide();
  const auto &v = box.solver->fluid().v;
  const double sign = uniform(CounterRandom{1, 0}.mixed(Stream::Rotation).word(0, 1 + 4 * 2)) < 0.5 ? 1 : -1;
  const double x[] = {0.5, -1.5, 1.5, -0.5}, y[] = {-1.5, 0.5, 1.5, -0.5};    // relative
  for (int i = 0; i < 4; ++i) {
    CHECK(close(v[0][i], 0.5 - sign * y[i]));
    CHECK(close(v[1][i], 1.5 + sign * x[i]));
  }
  CHECK(close(v[0][4], 7) && close(v[1][4], -2));    // alone in its cell
  CHECK(close(box.solver->momentum()[0], 9) && close(box.solver->momentum()[1], 4));
}

void rotation_in_three_dimensions_is_orthogonal()
{
  for (auto axes : {Axes::Coordinate, Axes::Random})
    for (int cell = 0; cell < 50; ++cell) {
      Turn<3> turn;
      Rotation(2.0, axes).draw(CounterRandom{3, 1}.mixed(Stream::Rotation), cell, turn);
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          double product = 0;
          for (int c = 0; c < 3; ++c) product += turn.column[a][c] * turn.column[b][c];
          CHECK(close(product, a == b, 1e-14));
        }
      double trace = 0;
      for (int a = 0; a < 3; ++a) trace += turn.column[a][a];
      CHECK(close(trace, 1 + 2 * std::cos(2.0)));    // of a rotation by 2 rad
    }
}

// From y = 0.3 at v_y = -1 a wall is met after 0.3; the particle goes back along its way.
void bounce_back_reverses()
{
  const NoSlipWalls<2> walls(box_grid<2>(true), 10, 1);
  Vector<2> x{1, 0.3}, v{2, -1};
  CHECK(fly_between<2>(walls, x, v, {}, 0.5));
  CHECK(close(x[0], 1 + 2 * 0.3 - 2 * 0.2) && close(x[1], 0.2));
  CHECK(v[0] == -2 && v[1] == 1);
  // falling: 0.08 = t_c^2 / 2 of an acceleration 1 gives t_c = 0.4 and a speed of 0.4
  x = {0, 0.08};
  v = {0, 0};
  CHECK(fly_between<2>(walls, x, v, {0, -1}, 0.8));
  CHECK(close(x[1], 0.08) && close(v[1], 0));
}

void wrapping_keeps_particles_in_the_box()
{
  Box<2> box({{0, {0.05, 3.95}, {-1, 1}}, {1, {2, 2}, {50, 0}}});
  box.collide();
  const auto &fluid = box.solver->fluid();
  CHECK(close(fluid.x[0][0], 3.95) && close(fluid.x[1][0], 0.05));
  CHECK(close(fluid.x[0][1], 3.0, 1e-12));    // 2 + 50 * 0.1 = 7, more than a box further
  CHECK(fluid.size() == 2);
}

void a_lost_particle_is_named()
{
  for (double bad : {std::nan(""), HUGE_VAL}) {
    Box<2> box({{0, {1, 1}, {0, 0}}, {17, {2, 2}, {0, bad}}});
    try {
      box.collide();
      CHECK(false);
    } catch (const Fault &fault) {
      CHECK(std::string(fault.what()).find("fluid particle 17") == 0);
    }
  }
}

// From y = 1 at v_y = 1e8 the walls at 0 and 4 are met 2.5 million times in 0.1.
void a_particle_that_meets_the_walls_too_often_is_named()
{
  auto how = method<2>();
  how.walls = std::make_unique<NoSlipWalls<2>>(box_grid<2>(true), 10, 1.0);
  Box<2> box({{0, {1, 1}, {0, 0}}, {17, {2, 1}, {0, 1e8}}}, std::move(how));
  try {
    box.collide();
    CHECK(false);
  } catch (const Fault &fault) {
    CHECK(std::string(fault.what()).find("fluid particle 17 meets the walls") == 0);
  }
}

// They name the same random numbers everywhere, and stay with their particles.
void numbers_have_more_than_32_bits()
{
  for (const double first : {0.0, 0x1p32 - 2, 0x1p47}) {
    auto how = method<2>(0);
    how.random_solvent = std::make_unique<BathSolvent<2>>(1.0);
    Box<2> box({}, std::move(how));
    for (int n = 0; n < 4; ++n) box.solver->add({first + n, {1, 1}, {0, 0}});
    box.collide();
    box.solver->turn();
    const auto keys = CounterRandom{1, 0}.words(Stream::Bath, 0);
    for (int n = 0; n < 4; ++n) {
      const auto number = static_cast<std::uint64_t>(first) + n;
      CHECK(box.solver->fluid().number(n) == number);
      const auto z = normal_pair(uniform(split_mix(keys[0], number)),
                                 uniform(split_mix(keys[1], number)));
      for (int a = 0; a < 2; ++a) CHECK(box.solver->fluid().v[a][n] == z[a]);
    }

    const Grid<2> grid({32, 32}, {true, true}, 1);
    Fluid<2> fluid;
    for (int n = 0; n < 2000; ++n) {
      const Vector<2> x{n * 37 % 32 + 0.5, n / 32 % 32 + 0.5};
      fluid.append({first + n, x, {1.0 * n, 0}}, grid.local(x));
    }
    CHECK(fluid.id_high.empty() == (first == 0));
    TileOrder<2>().sort(fluid, grid);
    fluid.remove(3);
    for (int i = 0; i < fluid.size(); ++i) CHECK(fluid.particle(i).id == first + fluid.v[0][i]);
    const double bytes = fluid.bytes() / fluid.id.capacity();
    CHECK(bytes == (first == 0 ? 40 : 42));
  }
}

void the_permutation_is_one()
{
  for (int count : {1, 2, 5, 16, 17, 24, 1000})
    for (std::uint64_t collision = 0; collision < 50; ++collision) {
      Permutation permutation(count);
      permutation.draw({9, collision});
      std::vector<std::uint64_t> numbers(count), images(count);
      std::iota(numbers.begin(), numbers.end(), 0);
      for (int i = 0; i < count; ++i) {
        const auto image = permutation.once(i);
        images[i] = image < images.size() ? image : permutation.below(image);
      }
      CHECK(std::is_permutation(images.begin(), images.end(), numbers.begin()));
    }
}

// (factor i + term) mod p in whole numbers, for the largest prime below 2^31.
void quotients_of_the_permutation_are_exact()
{
  constexpr std::uint64_t prime = (std::uint64_t{1} << 31) - 1;
  Permutation permutation(prime);
  CHECK(permutation.prime() == prime);
  for (std::uint64_t collision = 0; collision < 1000; ++collision) {
    const CounterRandom random{1, collision};
    permutation.draw(random);
    const auto u = uniforms(random.words(Stream::Shuffle, 0));
    const auto factor = 1 + static_cast<std::uint64_t>(u[0] * (prime - 1));
    const auto term = static_cast<std::uint64_t>(u[1] * prime);
    for (std::uint64_t i : {std::uint64_t{0}, std::uint64_t{1}, prime / 2, prime - 2, prime - 1}) {
      CHECK(permutation.once(i) == (factor * i + term) % prime);
      const auto zero = (prime - term) % prime;    // images about 0 and p
      CHECK(permutation.once(zero) == (factor * zero + term) % prime);
    }
  }
}

// Those that its authors' program gives.
void split_mix_known_answers()
{
  CHECK(split_mix(1234567, 0) == 6457827717110365317u);
  CHECK(split_mix(1234567, 1) == 3203168211198807973u);
}

void logarithm_cosine_and_sine_are_those_of_the_c_library()
{
  constexpr long double pi = 3.14159265358979323846264338328L;
  const auto agree = [](double value, long double exact) {    // which is rounded itself, as pi is
    return std::abs(value - exact) <= 4 * DBL_EPSILON * std::abs(exact) + 8 * LDBL_EPSILON;
  };
  const auto check_at = [&](double u) {
    const auto [cosine, sine] = cosine_and_sine_of_turn(u);
    CHECK(agree(logarithm(1 - u), std::log1p(-static_cast<long double>(u))));
    CHECK(agree(cosine, std::cos(2 * pi * u)));
    CHECK(agree(sine, std::sin(2 * pi * u)));
  };
  for (int eighth = 0; eighth < 8; ++eighth)
    for (double beside : {-0x1p-53, 0.0, 0x1p-53})
      if (const double u = 0.125 * eighth + beside; u >= 0) check_at(u);
  check_at(1 - 0x1p-53);
  for (int i = 0; i < 1000000; ++i)
    check_at(uniform(CounterRandom{3, 0}.words(Stream::Bath, i)[0]));
}

// A fluid of 1000 particles, deterministic.
template <int D> std::vector<Particle<D>> many(int count)
{
  std::vector<Particle<D>> particles;
  for (int i = 0; i < count; ++i) {
    const auto words = CounterRandom{77, 0}.words(Stream::Create, i);
    Particle<D> particle{static_cast<double>(i), {}, {}};
    for (int a = 0; a < D; ++a) {
      particle.x[a] = 4 * uniform(words[a]);
      particle.v[a] = normals<D>(words)[a];
    }
    particles.push_back(particle);
  }
  return particles;
}

double energy(const Fluid<2> &fluid)
{
  double sum = 0;
  for (const auto &component : fluid.v)
    for (double v : component) sum += v * v;
  return 0.5 * sum;
}

void momentum_and_energy_are_kept()
{
  Box<2> box(many<2>(160));
  const auto momentum = box.solver->momentum();
  const double before = energy(box.solver->fluid());
  for (int k = 0; k < 300; ++k) box.collide();
  CHECK(close(box.solver->momentum()[0], momentum[0], 1e-11));
  CHECK(close(box.solver->momentum()[1], momentum[1], 1e-11));
  CHECK(close(energy(box.solver->fluid()), before, 1e-11 * before));
}

void thermostats_reach_their_temperature()
{
  auto how = method<2>();
  how.thermostat = std::make_unique<RescalingThermostat<2>>(1.0);
  Box<2> rescaled(many<2>(160), std::move(how));
  rescaled.collide();
  CHECK(close(energy(rescaled.solver->fluid()), 160, 1e-11));

  how = method<2>();
  how.shifted = false;
  how.interval = 0;
  how.thermostat = std::make_unique<LayerThermostat<2>>(2.0);
  Box<2> layered(many<2>(160), std::move(how));
  layered.collide();
  // one layer of 4 cells has 2 (n - 4) / 2 kT of relative energy
  const auto &fluid = layered.solver->fluid();
  CellSums<2> sums{Array<CellSum<2>>(4), {}};
  for (int i = 0; i < fluid.size(); ++i)
    if (fluid.cell[i] < 4) {
      const double x = fluid.v[0][i], y = fluid.v[1][i];
      sums.of[fluid.cell[i]].momentum += pack(x, y);
      sums.of[fluid.cell[i]].squares_and_count += pack(x * x + y * y, 1);
    }
  double relative = 0, free = -4;
  for (int cell = 0; cell < 4; ++cell) {
    relative += sums.relative_energy(cell);
    free += sums.number(cell);
  }
  CHECK(close(relative, free * 2.0, 1e-11));
}

// A wall cell without fluid has v_cm = zeta / n_f: of variance T / n_f in each component.
void virtual_particles_have_the_right_variance()
{
  const NoSlipWalls<2> walls(box_grid<2>(true), 10, 2);
  const Cut<2> lower{{0, -1}, 1};
  const CellSums<2> empty{Array<CellSum<2>>(1), {}};
  double square_sum = 0;
  constexpr int draws = 20000;
  for (int cell = 0; cell < draws; ++cell)
    square_sum += square<2>(walls.mean_of_cut(lower, empty, 0, CounterRandom{5, 0}, cell));
  CHECK(close(square_sum / draws, 2 * 2.0 / 10, 0.4 * 5 / std::sqrt(draws)));    // 5 sigma
}

// Which rows of cells reach beyond y = 0 or 4, on a grid shifted by 0.3: of 0 ... 4 the ends.
void walls_cut_the_rows_that_reach_beyond_them()
{
  auto grid = box_grid<2>(true);
  const NoSlipWalls<2> walls(grid, 10, 1);
  const auto side = [&](int row) { return walls.cutting(grid, {2, row}).sides[1]; };
  CHECK(side(0) == 0 && side(3) == 0 && side(4) == 1);
  grid.shift = {0.9, 0.3};
  CHECK(side(0) == -1 && side(4) == 1);
  for (int row : {1, 2, 3}) CHECK(side(row) == 0);
}

// In a tube a particle meets one wall after 0.1 and the other after 0.2 more; each sends it back
// the way that it came, in its frame.
void two_pairs_of_walls_that_move()
{
  const Grid<3> grid({4, 4, 4}, {true, false, false}, 1.0);
  FaceVectors<3> velocities{};
  velocities[Face{1, true}.number()] = {3, 0, 0};
  const NoSlipWalls<3> walls(grid, 10, 1, velocities);
  CHECK(walls.gain() == 6);
  Vector<3> x{1, 3.9, 3.7}, v{0, 1, 1};
  CHECK(fly_between<3>(walls, x, v, {}, 0.4));    // upper y at z = 3.8, then away from both
  CHECK(close(x[0], 1 + 0.3 * 6) && close(x[1], 3.7) && close(x[2], 3.5));
  CHECK(v[0] == 6 && v[1] == -1 && v[2] == -1);
  const auto corner = walls.cutting(grid, {2, 4, 4});
  CHECK(corner.count == 2 && corner.sides[0] == 0 && corner.sides[1] == 1 && corner.sides[2] == 1);
  // a corner without fluid: on average the mean of a wall at 3 and one at rest
  const CellSums<3> empty{Array<CellSum<3>>(1), {}};
  Vector<3> sum{};
  constexpr int draws = 20000;
  for (int cell = 0; cell < draws; ++cell) {
    const auto mean = walls.mean_of_cut(corner, empty, 0, CounterRandom{5, 0}, cell);
    for (int a = 0; a < 3; ++a) sum[a] += mean[a] / draws;
  }
  for (int a = 0; a < 3; ++a) CHECK(close(sum[a], a == 0 ? 1.5 : 0, 5 * std::sqrt(0.1 / draws)));
}

// A particle of (3, -2) that a wall of 1 along x sends back as (-1, 2) has left (4, -4) there. What
// walls take up in an interval is what the fluid loses in flight and collision, thermostat and all.
void walls_take_up_what_the_fluid_loses()
{
  FaceVectors<2> velocities{};
  velocities[Face{1, false}.number()] = {1, 0};
  NoSlipWalls<2> slow(box_grid<2>(true), 10, 1, velocities);
  Vector<2> v{3, -2};
  slow.contact({1, false}, v);
  CHECK(v[0] == -1 && v[1] == 2);
  CHECK(slow.taken()[2][0] == 4 && slow.taken()[2][1] == -4 && slow.taken()[3][0] == 0);
  slow.take({{0, 1}, 1}, {5, 6});
  CHECK(slow.taken()[3][0] == 5 && slow.taken()[3][1] == 6);
  slow.forget();
  CHECK(slow.taken()[2][0] == 0 && slow.taken()[3][1] == 0);

  auto how = method<2>();
  how.interval = 0.5;
  how.field = {0.3, 0};
  how.walls = std::make_unique<NoSlipWalls<2>>(box_grid<2>(true), 12, 1, velocities);
  how.thermostat = std::make_unique<MonteCarloThermostat<2>>(1.0);
  Box<2> box(many<2>(160), std::move(how));
  double most = 0;
  for (int k = 0; k < 20; ++k) {
    const auto before = box.solver->momentum();
    box.collide();
    const auto after = box.solver->momentum();
    const auto taken = box.solver->momentum_of_walls();
    for (int a = 0; a < 2; ++a) {
      const double given = a == 0 ? 160 * 0.3 * 0.5 : 0;
      CHECK(close(before[a] + given - after[a], taken[2][a] + taken[3][a], 1e-11));
      CHECK(taken[0][a] == 0 && taken[1][a] == 0);    // there are none across x
    }
    most = std::max(most, std::abs(taken[3][1]));
  }
  CHECK(most > 1);
}

std::unique_ptr<Walls<2>> sliding(const Grid<2> &grid, double density, double speed)
{
  FaceVectors<2> velocities{};
  velocities[Face{1, false}.number()] = {-speed, 0};
  velocities[Face{1, true}.number()] = {speed, 0};
  return std::make_unique<NoSlipWalls<2>>(grid, density, 1.0, velocities);
}

// Mean and its standard error.
std::array<double, 2> estimate(const std::vector<double> &samples)
{
  double sum = 0, squares = 0;
  for (double sample : samples) sum += sample;
  const double mean = sum / samples.size();
  for (double sample : samples) squares += (sample - mean) * (sample - mean);
  return {mean, std::sqrt(squares / (samples.size() * (samples.size() - 1.0)))};
}

// Couette flow: a straight line between the walls, whose slope says that the fluid slips as past
// walls at rest: by a length of 0.20 +- 0.01 (docs/reference.md). Bounds are 4 standard errors. Less
// than a cell from the walls the line bends, as the last half cell lags by 0.6 % of their speed.
void sliding_walls_drive_couette_flow()
{
  constexpr int length = 32, width = 10, bins = 20, skip = 2, blocks = 60, collisions = 250;
  constexpr double speed = 1, density = 10;
  Processes alone;
  const Grid<2> grid({length, width}, {true, false}, 1.0);
  auto how = method<2>();
  how.walls = sliding(grid, density, speed);
  how.thermostat = std::make_unique<LayerThermostat<2>>(1.0);
  Solver<2> solver(grid, std::move(how), alone);
  solver.reset(0, grid.lower, grid.upper);
  for (int i = 0; i < density * length * width; ++i) {
    const auto words = CounterRandom{77, 0}.words(Stream::Create, i);
    const auto u = uniforms(words);
    const auto z = normals<2>(CounterRandom{77, 1}.words(Stream::Create, i));
    solver.add({static_cast<double>(i), {length * u[0], width * u[1]}, {z[0], z[1]}});
  }
  solver.count();

  const auto from_middle = [&](int b) { return (b + 0.5) * width / bins - 0.5 * width; };
  std::vector<double> slopes, middles, profile[bins];
  for (int block = -4; block < blocks; ++block) {    // the first to reach the steady state
    std::vector<Layer> sum(bins);
    for (int k = 0; k < collisions; ++k) {
      solver.begin_interval({}, 0);
      solver.end_interval();
      if (k % 5) continue;
      solver.turn();
      const auto now = layers<2>(solver.fluid(), grid, bins, alone);
      for (int b = 0; b < bins; ++b) {
        sum[b].count += now[b].count;
        sum[b].momentum_x += now[b].momentum_x;
      }
    }
    if (block < 0) continue;
    double covariance = 0, variance = 0, middle = 0;
    for (int b = skip; b < bins - skip; ++b) {
      const double y = from_middle(b), v = sum[b].momentum_x / sum[b].count;
      covariance += y * v;
      variance += y * y;
      middle += v / (bins - 2 * skip);
      profile[b].push_back(v);
    }
    slopes.push_back(covariance / variance);
    middles.push_back(middle);
  }
  const auto [slope, slope_error] = estimate(slopes);
  const auto [middle, middle_error] = estimate(middles);
  const double slip = speed / slope - 0.5 * width;
  const double slip_error = speed / (slope * slope) * slope_error;
  std::printf("Couette flow: slip length %.3f +- %.3f\n", slip, slip_error);
  CHECK(slip_error < 0.02 && close(slip, 0.20, 4 * std::hypot(slip_error, 0.01)));
  CHECK(close(middle, 0, 4 * middle_error));
  for (int b = skip; b < bins - skip; ++b) {
    const auto [v, error] = estimate(profile[b]);
    CHECK(error < 0.005 * speed && close(v, slope * from_middle(b), 4 * error));
  }
}

// One type of colloid that repels.
std::unique_ptr<Coupling<2>> repulsion(double interval, double sigma, const Walls<2> *walls = nullptr)
{
  ForceCoupling<2>::Interactions interactions{{1, {1.0, sigma}}};
  return std::make_unique<ForceCoupling<2>>(interactions, interval, 1.0, Vector<2>{}, walls);
}

Colloid<2> disk(double id, Vector<2> x, Vector<2> v = {}, double mass = 1)
{
  return {id, 1, x, v, {}, mass, 0.4 * mass};
}

// At its own speed the particle moves 0.1 in the interval; thrown by a fast wall, close to 4. The
// colloid's cutoff begins 0.9 away.
void fluid_thrown_by_a_wall_is_near()
{
  for (double speed : {0.0, 20.0}) {
    auto how = method<2>(0.1);
    how.walls = sliding(box_grid<2>(true), 10, speed);
    how.coupling = repulsion(0.1, 1.0, how.walls.get());
    Box<2> box({{0, {1, 3.99}, {0, 1}}}, std::move(how));
    box.solver->begin_interval({disk(0, {3, 3.5})}, 0.0);
    CHECK(box.solver->coupling()->taken().size() == (speed > 0));
  }
}

// Sums by layer: two particles in the lower half, one in the upper.
void layers_are_sums()
{
  Box<2> box({{0, {1, 0.5}, {1, 2}}, {1, {2, 1.5}, {3, 0}}, {2, {3, 3}, {-1, 0}}});
  const auto layers = mpc::layers<2>(box.solver->fluid(), box.grid, 2, box.alone);
  CHECK(layers[0].count == 2 && layers[0].momentum_x == 4 && layers[0].squares == 14);
  CHECK(close(layers[0].deviation, 14 - 16.0 / 2 - 4.0 / 2));
  CHECK(layers[1].count == 1 && layers[1].deviation == 0);
  CHECK(close(temperature(layers, 2), 4.0 / (2 * 1)));
}

// The coupling, moved by hand through one interval, against integrating all of the fluid.
void only_what_is_near_needs_integration()
{
  constexpr double interval = 0.15, step = 0.01, sigma = 0.7;
  const auto particles = [&] {
    std::vector<Particle<2>> kept;
    for (const auto &particle : many<2>(400))
      if (square<2>({particle.x[0] - 2, particle.x[1] - 2}) > 0.6 * 0.6) kept.push_back(particle);
    return kept;
  }();
  auto how = method<2>(interval);
  how.coupling = repulsion(interval, sigma);
  Box<2> box(particles, std::move(how));
  std::vector<Colloid<2>> colloids{disk(0, {2, 2})};
  std::vector<Push<2>> forces(1);
  box.solver->begin_interval(colloids, 0.1);
  auto &coupling = *box.solver->coupling();
  const auto taken = coupling.taken().size();
  CHECK(taken > 20 && taken < particles.size() / 2);
  for (int k = 0; k < 15; ++k) coupling.step(step, colloids, forces);
  Fluid<2> near = box.solver->fluid();
  coupling.give_back(near);

  for (int i = 0; i < near.size(); ++i) {
    Vector<2> x{}, v{};
    for (const auto &particle : particles)
      if (particle.id == near.id[i]) {
        x = particle.x;
        v = particle.v;
      }
    const auto force = [&] {
      const Vector<2> r{x[0] - 2, x[1] - 2};
      const double r2 = square<2>(r), u = std::pow(sigma * sigma / r2, 3);
      const double f = r2 < std::pow(2.0, 1.0 / 3) * sigma * sigma ? 24 * (2 * u * u - u) / r2 : 0;
      return Vector<2>{f * r[0], f * r[1]};
    };
    auto f = force();
    for (int k = 0; k < 15; ++k) {
      for (int a = 0; a < 2; ++a) x[a] += step * (v[a] += 0.5 * step * f[a]);
      f = force();
      for (int a = 0; a < 2; ++a) v[a] += 0.5 * step * f[a];
    }
    for (int a = 0; a < 2; ++a) {
      const double apart = near.x[a][i] - x[a];
      CHECK(close(apart - 4 * std::round(apart / 4), 0, 1e-11));
      CHECK(close(near.v[a][i], v[a], 1e-11));
    }
  }
}

// A fluid and colloids of mass 20 in it, for as long as the colloids take part in the collision.
void colloids_may_take_part_in_the_collision()
{
  auto how = method<2>();
  how.coupling = std::make_unique<CellCoupling<2>>();
  Box<2> box(many<2>(160), std::move(how));
  // the last is an image's place; two share a cell
  std::vector<Colloid<2>> colloids{disk(1, {1.3, 2.2}, {0.5, -1}, 20), disk(2, {1.3, 2.2}, {2, 0}, 7),
                                   disk(3, {-0.5, 6.1}, {0, 0}, 30)};
  const auto totals = [&] {
    auto sum = box.solver->momentum();
    double squares = 0;
    for (const auto &component : box.solver->fluid().v)
      for (double each : component) squares += each * each;
    for (const auto &colloid : colloids) {
      for (int a = 0; a < 2; ++a) sum[a] += colloid.mass * colloid.v[a];
      squares += colloid.mass * square<2>(colloid.v);
    }
    return std::array<double, 3>{sum[0], sum[1], squares};
  };
  const auto before = totals();
  for (int k = 0; k < 10; ++k) {
    box.solver->begin_interval(colloids, 0);
    box.solver->end_interval(colloids);
    for (std::size_t c = 0; c < colloids.size(); ++c)
      for (int a = 0; a < 2; ++a)
        colloids[c].v[a] += box.solver->coupling()->impulses()[c].linear[a] / colloids[c].mass;
  }
  const auto after = totals();
  for (int k = 0; k < 3; ++k) CHECK(close(after[k], before[k], 1e-11));
  CHECK(!close(colloids[2].v[0], 0, 0.01));
}

// Mass is not number: a cell of three fluid particles and a colloid of mass 20 has 2 (4 - 1)
// degrees of freedom, and the mean velocity of 23 masses.
void sums_tell_mass_from_number()
{
  CellSums<2> sums{Array<CellSum<2>>(1), Array<Guests>(1)};
  for (double v : {1.0, 2.0, 3.0}) {
    sums.of[0].momentum += pack(v, 0);
    sums.of[0].squares_and_count += pack(v * v, 1);
  }
  sums.add(0, {-1, 2}, 20);
  CHECK(sums.number(0) == 4 && sums.mass(0) == 23);
  CHECK(close(sums.mean(0)[0], -14.0 / 23) && close(sums.mean(0)[1], 40.0 / 23));
  const double squares = 14 + 20 * 5.0, of_mean = (14.0 * 14 + 40 * 40) / 23;
  CHECK(close(sums.relative_energy(0), 0.5 * (squares - of_mean), 1e-12));
}

// A particle flies into a disk of radius 1 at (2, 2) along x, from 1.2 away; in 0.1 at a speed of 4
// it comes in after 0.05. It leaves outwards, from the point where it came in or the nearest.
void reflection_puts_fluid_outside()
{
  for (auto placement : {Placement::Nearest, Placement::Entry}) {
    auto how = method<2>(0.1);
    how.coupling = std::make_unique<ReflectionCoupling<2>>(ReflectionCoupling<2>::Radii{{1, 1.0}},
                                                           placement, 0.1, 1.0, Vector<2>{}, nullptr);
    Box<2> box({{9, {0.8, 2.0}, {4, 0}}, {10, {0.8, 3.5}, {4, 0}}}, std::move(how));
    std::vector<Colloid<2>> colloids{disk(5, {2, 2}, {}, 50)};
    box.solver->begin_interval(colloids, 0.0);
    box.solver->end_interval(colloids);
    box.solver->turn();
    const auto &fluid = box.solver->fluid();
    const int i = fluid.id[0] == 9 ? 0 : 1;
    const auto &push = box.solver->coupling()->impulses()[0];
    CHECK(fluid.x[0][i] < 1 && square<2>({fluid.x[0][i] - 2, fluid.x[1][i] - 2}) > 1);
    CHECK(fluid.v[0][i] < 0);
    CHECK(close(fluid.x[0][i], 1 + 0.05 * fluid.v[0][i], 1e-12));    // half a step in both here
    CHECK(close(push.linear[0], 4 - fluid.v[0][i], 1e-12));
    CHECK(close(push.linear[1], -fluid.v[1][i], 1e-12));
    CHECK(close(push.angular[0], fluid.v[1][i], 1e-12));    // at the arm (-1, 0): -1 x -v_y
    CHECK(close(fluid.x[0][1 - i], 1.2));                   // the other was not touched
  }
}

// Several contacts in an interval: what the colloid gains is what the fluid loses, about any point.
void reflection_keeps_momentum()
{
  auto how = method<3>(0.1);
  how.shifted = false;    // else cells at the ends would need images of the colloid
  how.coupling = std::make_unique<ReflectionCoupling<3>>(ReflectionCoupling<3>::Radii{{1, 1.2}},
                                                         Placement::Entry, 0.1, 1.0, Vector<3>{}, nullptr);
  std::vector<Colloid<3>> colloids{{5, 1, {2, 2, 2}, {0.5, 0, 0}, {0, 0, 1}, 30, 0.4 * 30 * 1.44}};
  std::vector<Particle<3>> outside;
  for (const auto &particle : many<3>(640))
    if (square<3>({particle.x[0] - 2, particle.x[1] - 2, particle.x[2] - 2}) > 1.44)
      outside.push_back(particle);
  Box<3> box(outside, std::move(how));
  auto before = box.solver->momentum();
  for (int k = 0; k < 20; ++k) {
    box.solver->begin_interval(colloids, 0.0);
    box.solver->end_interval(colloids);
    const auto &push = box.solver->coupling()->impulses()[0];
    const auto after = box.solver->momentum();
    for (int a = 0; a < 3; ++a) CHECK(close(after[a] + push.linear[a], before[a], 1e-11));
    CHECK(square<3>(push.linear) > 0);
    before = after;
    const auto &fluid = box.solver->fluid();
    for (int i = 0; i < fluid.size(); ++i)
      CHECK(square<3>({fluid.x[0][i] - 2, fluid.x[1][i] - 2, fluid.x[2][i] - 2}) > 1.44);
  }
}

// Action is reaction, through the periodic boundary too, and what is too deep or too far is named.
void coupling_faults()
{
  const auto with = [](Vector<2> fluid, Vector<2> colloid, Vector<2> later) {
    auto how = method<2>(0.1);
    how.coupling = repulsion(0.1, 1.0);
    Box<2> box({{23, fluid, {0, 0}}}, std::move(how));
    std::vector<Colloid<2>> colloids{disk(5, colloid)};
    std::vector<Push<2>> forces(1);
    try {
      box.solver->begin_interval(colloids, 1.0);
      colloids[0].x = later;
      box.solver->coupling()->forces(colloids, forces);
    } catch (const Fault &fault) {
      return std::string(fault.what());
    }
    return std::to_string(forces[0].linear[0]);
  };
  CHECK(with({2.4, 2}, {2, 2}, {2, 2}).find("fluid particle 23 is 0.4 from the centre of colloid 5")
        == 0);
  CHECK(with({3, 2}, {2, 2}, {2.2, 2}).find("colloid 5 moved by 0.2") == 0);
  CHECK(close(std::stod(with({3, 2}, {2, 2}, {2, 2})), -24, 1e-9));    // 24 (2 - 1) at r = sigma
  CHECK(close(std::stod(with({3.9, 2}, {4.9, 2}, {4.9, 2})), 24, 1e-9));    // an image
}

// Buffers for sorting included; 10 particles in a cell.
template <int D> void memory_per_particle(int cells, double most)
{
  Processes alone;
  Vector<D> box;
  box.fill(cells);
  std::array<bool, D> periodic;
  periodic.fill(true);
  const Grid<D> grid(box, periodic, 1.0);
  Solver<D> solver(grid, method<D>(), alone);
  solver.reset(0, grid.lower, grid.upper);
  const int count = 10 * grid.cells();
  for (int i = 0; i < count; ++i) {
    Particle<D> particle{static_cast<double>(i), {}, {}};
    const auto u = uniforms(CounterRandom{1, 0}.words(Stream::Create, i));
    for (int a = 0; a < D; ++a) particle.x[a] = cells * u[a];
    solver.add(particle);
  }
  solver.count();
  solver.begin_interval({}, 0);
  solver.end_interval();
  CHECK(solver.memory() / count <= most);
}

// All velocities, once more, and a few places for the prime.
void memory_of_shuffle()
{
  Processes alone;
  const Grid<2> grid({100, 100}, {true, true}, 1.0);
  const auto memory = [&](std::unique_ptr<RandomSolvent<2>> solvent) {
    auto shuffled = method<2>();
    shuffled.random_solvent = std::move(solvent);
    Solver<2> solver(grid, std::move(shuffled), alone);
    solver.reset(0, grid.lower, grid.upper);
    for (int i = 0; i < 1000; ++i) solver.add({static_cast<double>(i), {0.1 * i, 50.0}, {}});
    solver.count();
    solver.begin_interval({}, 0);
    solver.end_interval();
    return solver.memory();
  };
  const double more = memory(std::make_unique<ShuffledSolvent<2>>()) - memory(nullptr);
  CHECK(more >= 1000 * sizeof(Pack<2>) && more < 1100 * sizeof(Pack<2>));
}

}    // namespace

// A fluid between walls or not, and the same one in single precision: a place and a digit are 1e-6
// and 1e-7 of what they are of. The field gives each particle a tenth of its last digit at a time.
template <int D> void single_precision_follows_double(bool walls)
{
  const auto grid = box_grid<D>(walls);
  Processes alone;
  const auto how = [&] {
    auto how = method<D>();
    how.field[0] = 1e-7;
    if (walls) how.walls = std::make_unique<NoSlipWalls<D>>(grid, 5, 1.0);
    if (walls) how.thermostat = std::make_unique<LayerThermostat<D>>(1.0);
    return how;
  };
  Solver<D> exact(grid, how(), alone);
  Solver<D, float> single(grid, how(), alone);
  const int count = static_cast<int>(5 * std::pow(4, D));
  for (AnySolver<D> *solver : std::array<AnySolver<D> *, 2>{&exact, &single}) {
    solver->reset(0, grid.lower, grid.upper);
    for (int i = 0; i < count; ++i) {
      Particle<D> particle{static_cast<double>(i), {}, {}};
      const auto u = uniforms(CounterRandom{5, 0}.words(Stream::Create, i));
      const auto z = normals<D>(CounterRandom{5, 1}.words(Stream::Create, i));
      for (int a = 0; a < D; ++a) {
        particle.x[a] = 4 * u[a];
        particle.v[a] = z[a];
      }
      solver->add(particle);
    }
    solver->count();
    for (int collision = 0; collision < 20; ++collision) {
      solver->begin_interval({}, 0);
      solver->end_interval({});
    }
    solver->turn();
  }
  double largest = 0;
  for (int i = 0; i < count; ++i) {
    const auto one = exact.particle(i), other = single.particle(i);
    CHECK(one.id == other.id);
    for (int a = 0; a < D; ++a) {
      const double apart = one.x[a] - other.x[a];
      largest = std::max(largest, std::abs(apart - 4 * std::round(apart / 4)));
      largest = std::max(largest, std::abs(one.v[a] - other.v[a]));
    }
  }
  CHECK(largest > 1e-8 && largest < 1e-4);    // 5e-5 with walls; another random number: 0.1
}

// However little a field gives at a time, it gives all of it: 1e-8 in each of 3000 intervals, where
// the last digit of a velocity is 1e-7.
void single_precision_keeps_a_weak_field()
{
  const auto grid = box_grid<2>(false);
  Processes alone;
  auto how = method<2>();
  how.field = {1e-7, 0};
  Solver<2, float> solver(grid, std::move(how), alone);
  solver.reset(0, grid.lower, grid.upper);
  for (int i = 0; i < 160; ++i) {
    const auto u = uniforms(CounterRandom{6, 0}.words(Stream::Create, i));
    solver.add({static_cast<double>(i), {4 * u[0], 4 * u[1]}, {2 * u[2] - 1, 2 * u[3] - 1}});
  }
  solver.count();
  const double before = solver.momentum()[0] / 160;
  for (int collision = 0; collision < 3000; ++collision) {
    solver.begin_interval({}, 0);
    solver.end_interval({});
  }
  CHECK(close(solver.momentum()[0] / 160 - before, 3e-5, 5e-6));
}

// The single numbers nearest to cosine and sine of 130 degrees have the sum of squares 1 + 2.5e-8,
// which in 20 000 collisions would add 4e-4 to the energy.
template <int D> void single_precision_keeps_energy()
{
  const auto grid = box_grid<D>(false);
  Processes alone;
  auto how = method<D>();
  how.field = {};
  how.rotation = Rotation(130 * M_PI / 180, Axes::Coordinate);
  Solver<D, float> solver(grid, std::move(how), alone);
  solver.reset(0, grid.lower, grid.upper);
  const int count = static_cast<int>(5 * std::pow(4, D));
  for (int i = 0; i < count; ++i) {
    Particle<D> particle{static_cast<double>(i), {}, {}};
    const auto u = uniforms(CounterRandom{7, 0}.words(Stream::Create, i));
    const auto z = normals<D>(CounterRandom{7, 1}.words(Stream::Create, i));
    for (int a = 0; a < D; ++a) {
      particle.x[a] = 4 * u[a];
      particle.v[a] = z[a];
    }
    solver.add(particle);
  }
  solver.count();
  const auto energy = [&] {
    solver.turn();
    double energy = 0;
    for (int i = 0; i < count; ++i) energy += 0.5 * square<D>(solver.particle(i).v);
    return energy;
  };
  const double before = energy();
  for (int collision = 0; collision < 20000; ++collision) {
    solver.begin_interval({}, 0);
    solver.end_interval({});
  }
  CHECK(std::abs(energy() / before - 1) < 2e-5);    // a random walk, 1e-6 long
}

void what_single_precision_cannot_hold_is_named()
{
  const auto complaint = [](const auto &action) {
    try {
      action();
    } catch (const Fault &fault) {
      return std::string(fault.what());
    }
    return std::string();
  };
  Processes alone;
  const auto grid = box_grid<2>(false);
  for (double speed : {650.0, std::nan("")}) {    // 65 cells in 0.1
    Solver<2, float> solver(grid, method<2>(), alone);
    solver.reset(0, grid.lower, grid.upper);
    solver.add({17, {1, 1}, {0, speed}});
    CHECK(complaint([&] {
            solver.begin_interval({}, 0);
            solver.end_interval({});
          }).find("fluid particle 17") != std::string::npos);
  }
  const Grid<2> wide({4000, 4}, {true, true}, 1.0);
  Solver<2, float> solver(wide, method<2>(), alone);
  CHECK(complaint([&] { solver.reset(0, wide.lower, wide.upper); }) ==
        "precision single: 4000 cells along x on a process: must be at most 3900");
}

int main()
{
  philox_known_answers();
  four_particles_in_a_cell();
  rotation_in_three_dimensions_is_orthogonal();
  bounce_back_reverses();
  wrapping_keeps_particles_in_the_box();
  a_lost_particle_is_named();
  a_particle_that_meets_the_walls_too_often_is_named();
  numbers_have_more_than_32_bits();
  the_permutation_is_one();
  quotients_of_the_permutation_are_exact();
  split_mix_known_answers();
  logarithm_cosine_and_sine_are_those_of_the_c_library();
  momentum_and_energy_are_kept();
  thermostats_reach_their_temperature();
  virtual_particles_have_the_right_variance();
  walls_cut_the_rows_that_reach_beyond_them();
  two_pairs_of_walls_that_move();
  walls_take_up_what_the_fluid_loses();
  sliding_walls_drive_couette_flow();
  fluid_thrown_by_a_wall_is_near();
  layers_are_sums();
  only_what_is_near_needs_integration();
  coupling_faults();
  colloids_may_take_part_in_the_collision();
  sums_tell_mass_from_number();
  reflection_puts_fluid_outside();
  reflection_keeps_momentum();
  single_precision_follows_double<2>(false);
  single_precision_follows_double<2>(true);
  single_precision_follows_double<3>(false);
  single_precision_follows_double<3>(true);
  single_precision_keeps_a_weak_field();
  single_precision_keeps_energy<2>();
  single_precision_keeps_energy<3>();
  what_single_precision_cannot_hold_is_named();
  memory_per_particle<2>(100, 80);
  memory_per_particle<3>(22, 112);
  memory_of_shuffle();
  std::printf("%d failures\n", failures);
  return failures > 0;
}
