// Viscosity of the core's bulk fluid, by the protocol of tests/reference/test_viscosity.py: kicks keep
// a shear wave v_x = A sin(k y) at its amplitude. Run by test_viscosity.py. Prints the viscosity and its
// standard error.
//
//   core_viscosity SEED DIMENSION random|coordinate DENSITY ANGLE TAU LENGTH WIDTH AMPLITUDE GUESS DURATION

#include "solver.h"

#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

using namespace mpc;

namespace {

constexpr int KICK_INTERVAL = 5;    // collisions; longer than the memory of the stress
constexpr int BLOCKS = 20;

// Kicks the fluid, and remembers the amplitude before and after.
class KickedWave {
 public:
  KickedWave(double wavenumber, double kick) : wavenumber_(wavenumber), kick_(kick) {}

  template <int D> void kick(Solver<D> &solver)
  {
    const double particles = solver.particles();
    solver.momentum();    // velocities are then those after the last collision
    auto &fluid = const_cast<Fluid<D> &>(solver.fluid());    // no user needs a kick like this
    double mean = 0, squares = 0, amplitude = 0;
    sine_.resize(fluid.size());
    for (int i = 0; i < fluid.size(); ++i) {
      sine_[i] = std::sin(wavenumber_ * fluid.x[1][i]);
      mean += sine_[i] / particles;
      squares += sine_[i] * sine_[i] / particles;
      amplitude += 2 * fluid.v[0][i] * sine_[i] / particles;
    }
    for (int i = 0; i < fluid.size(); ++i) fluid.v[0][i] += kick_ * (sine_[i] - mean);
    before.push_back(amplitude);
    after.push_back(amplitude + 2 * kick_ * (squares - mean * mean));
  }

  std::vector<double> before, after;

 private:
  double wavenumber_, kick_;
  std::vector<double> sine_;
};

template <int D> int run(char **argument)
{
  const std::uint64_t seed = std::stoull(argument[1]);
  const auto axes = std::string(argument[3]) == "random" ? Axes::Random : Axes::Coordinate;
  const auto number = [&](int which) { return std::stod(argument[which]); };
  const double density = number(4), angle = number(5) * M_PI / 180, interval = number(6);
  const double length = number(7), width = number(8), amplitude = number(9);
  const double guess = number(10), duration = number(11);

  Vector<D> box;
  box.fill(length);
  box[1] = width;
  std::array<bool, D> periodic;
  periodic.fill(true);
  const Grid<D> grid(box, periodic, 1.0);
  const double wavenumber = 2 * M_PI / width, between = KICK_INTERVAL * interval;
  const double kick = -amplitude * std::expm1(-guess * wavenumber * wavenumber * between);
  KickedWave wave(wavenumber, kick);

  Method<D> method{seed, interval, {}, Rotation(angle, axes), true, {}, {}, {}, {}};
  method.thermostat = std::make_unique<LayerThermostat<D>>(1.0);
  Processes alone;
  Solver<D> solver(grid, std::move(method), alone);
  solver.reset(0, grid.lower, grid.upper);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  double count = density;
  for (double edge : box) count *= edge;
  for (int i = 0; i < std::lround(count); ++i) {
    Particle<D> particle{static_cast<double>(i), {}, {}};
    for (int a = 0; a < D; ++a) {
      particle.x[a] = box[a] * uniform(random);
      particle.v[a] = normal(random);
    }
    particle.v[0] += amplitude * std::sin(wavenumber * particle.x[1]);
    solver.add(particle);
  }
  solver.count();
  solver.zero_momentum();    // flow along y would carry the wave away
  const double settling = 2 / (guess * wavenumber * wavenumber);    // correlations build up
  const auto collisions = [&](double time) { return std::lround(time / between) * KICK_INTERVAL; };
  const long first = collisions(settling), last = first + collisions(duration);
  for (long c = 0; c < last; ++c) {
    solver.begin_interval({}, 0.0);
    solver.end_interval();
    if (solver.collisions() % KICK_INTERVAL == 0) wave.kick(solver);
  }

  // before[n + 1] = decay after[n] + thermal noise; the error is that of the blocks of the residuals
  const std::size_t begin = first / KICK_INTERVAL, end = wave.after.size() - 1;
  double sum_before = 0, sum_after = 0;
  for (std::size_t n = begin; n < end; ++n) {
    sum_after += wave.after[n];
    sum_before += wave.before[n + 1];
  }
  const double decay = sum_before / sum_after;
  std::vector<double> residual(BLOCKS);
  for (std::size_t n = begin; n < end; ++n)
    residual[(n - begin) * BLOCKS / (end - begin)] +=
        wave.before[n + 1] - decay * wave.after[n];
  double squares = 0;
  for (double block : residual) squares += block * block;
  const double rate = wavenumber * wavenumber * between;
  std::printf("%.8g %.8g\n", -std::log(decay) / rate, std::sqrt(squares) / sum_after / decay / rate);
  return 0;
}

}    // namespace

int main(int count, char **argument)
{
  if (count != 12) return 2;
  return std::string(argument[2]) == "2" ? run<2>(argument) : run<3>(argument);
}
