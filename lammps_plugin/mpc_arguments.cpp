#include "mpc_arguments.h"

#include "atom.h"
#include "domain.h"
#include "error.h"
#include "group.h"
#include "lammps.h"
#include "utils.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

using namespace LAMMPS_NS;

namespace {

constexpr int MOST_BINS = 10000000;    // of the flow: their sums are in the memory of each process

}    // namespace

template <int D>
MpcArguments<D>::MpcArguments(LAMMPS *lmp, int narg, char **arg)
{
  auto *error = lmp->error;
  const auto *domain = lmp->domain;
  if (narg < 8) utils::missing_cmd_args(FLERR, "fix mpc", error);

  const auto number = [&](int i, const char *name, bool valid_sign(double), const char *must) {
    const double value = utils::numeric(FLERR, arg[i], false, lmp);
    if (!valid_sign(value) || !std::isfinite(value))
      error->all(FLERR, "fix mpc: {} {}: must be {}", name, arg[i], must);
    return value;
  };
  const auto positive = [](double value) { return value > 0; };
  const auto not_negative = [](double value) { return value >= 0; };
  const auto finite = [](double) { return true; };
  const auto choice = [&](int i, const char *name, const std::vector<std::string> &choices) {
    for (const auto &each : choices)
      if (each == arg[i]) return each;
    std::string list;
    for (const auto &each : choices) list += (list.empty() ? "" : ", ") + each;
    error->all(FLERR, "fix mpc: {} {}: must be one of {}", name, arg[i], list);
  };

  every = utils::inumeric(FLERR, arg[3], false, lmp);
  if (every < 1) error->all(FLERR, "fix mpc: N {}: must be positive", arg[3]);
  if (std::string(arg[4]) != "NULL")
    colloid_bit = lmp->group->get_bitmask_by_id(FLERR, arg[4], "fix mpc");
  temperature = number(5, "temperature", positive, "positive");
  edge = number(6, "hgrid", positive, "positive");
  const auto integer = utils::bnumeric(FLERR, arg[7], false, lmp);
  if (integer < 1) error->all(FLERR, "fix mpc: seed {}: must be positive", arg[7]);
  seed = static_cast<std::uint64_t>(integer);
  for (int a = 0; a < D; ++a) {
    const double rows = domain->prd[a] / edge;
    if (domain->periodicity[a] && std::abs(rows - std::round(rows)) > 1e-9 * rows)
      error->all(FLERR, "fix mpc: hgrid {}: the periodic length {} of {} is not a multiple of it",
                 edge, domain->prd[a], "xyz"[a]);
    walls |= !domain->periodicity[a];
    if (rows < 2 - 1e-9)
      error->all(FLERR, "fix mpc: hgrid {}: less than 2 cells along {}", edge, "xyz"[a]);
  }

  int i = 8;
  const auto values = [&](int count) {
    if (i + count >= narg)
      error->all(FLERR, "fix mpc: {}: needs {} value(s)", arg[i], count);
    i += count + 1;
    return i - count;
  };
  while (i < narg) {
    const std::string keyword = arg[i];
    if (keyword == "create") {
      particles = number(values(1), "create", positive, "positive");
    } else if (keyword == "load") {
      load_file = arg[values(1)];
    } else if (keyword == "density") {
      density = number(values(1), "density", positive, "positive");
    } else if (keyword == "angle") {
      angle = number(values(1), "angle", positive, "positive");
    } else if (keyword == "axis") {
      axes = choice(values(1), "axis", {"random", "coordinate"}) == "random"
          ? mpc::Axes::Random
          : mpc::Axes::Coordinate;
    } else if (keyword == "precision") {
      single = choice(values(1), "precision", {"double", "single"}) == "single";
    } else if (keyword == "shift") {
      shifted = choice(values(1), "shift", {"yes", "no"}) == "yes";
    } else if (keyword == "tstat") {
      tstat = choice(values(1), "tstat",
                     {"none", "layer", "monte_carlo", "maxwell_boltzmann", "rescale", "andersen"});
    } else if (keyword == "hydro") {
      hydro = choice(values(1), "hydro", {"on", "shuffle", "bath"});
    } else if (keyword == "field") {
      const int first = values(3);
      for (int a = 0; a < D; ++a) field[a] = number(first + a, "field", finite, "finite");
    } else if (keyword == "force") {
      const int first = values(3);
      const int type = utils::inumeric(FLERR, arg[first], false, lmp);
      if (type < 1 || type > lmp->atom->ntypes)
        error->all(FLERR, "fix mpc: force {}: no such atom type", arg[first]);
      interactions[type] = {number(first + 1, "force epsilon", not_negative, "not negative"),
                             number(first + 2, "force sigma", positive, "positive")};
    } else if (keyword == "reflect") {
      const int first = values(3);
      const int type = utils::inumeric(FLERR, arg[first], false, lmp);
      if (type < 1 || type > lmp->atom->ntypes)
        error->all(FLERR, "fix mpc: reflect {}: no such atom type", arg[first]);
      radii[type] = number(first + 1, "reflect radius", positive, "positive");
      const auto place = choice(first + 2, "reflect placement", {"entry", "nearest"}) == "entry"
          ? mpc::Placement::Entry
          : mpc::Placement::Nearest;
      if (radii.size() > 1 && place != placement)
        error->all(FLERR, "fix mpc: reflect placement {}: must be the same for all types",
                   arg[first + 2]);
      placement = place;
    } else if (keyword == "collide") {
      in_collision = choice(values(1), "collide", {"yes", "no"}) == "yes";
    } else if (keyword == "wall") {
      const int first = values(4);
      const std::vector<std::string> faces{"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"};
      const auto face = choice(first, "wall", {faces.begin(), faces.begin() + 2 * D});
      const int which =
          static_cast<int>(std::find(faces.begin(), faces.end(), face) - faces.begin());
      if (domain->periodicity[which / 2])
        error->all(FLERR, "fix mpc: wall {}: the face is periodic", face);
      for (int a = 0; a < D; ++a)
        wall_velocities[which][a] = number(first + 1 + a, "wall velocity", finite, "finite");
      for (int a = 0; a < D; ++a)
        if (wall_velocities[which][a] != 0 && !domain->periodicity[a])
          error->all(FLERR, "fix mpc: wall {}: it can move along periodic axes only, its v{} must be 0",
                     face, "xyz"[a]);
    } else if (keyword == "virtual") {
      virtual_particles = choice(values(1), "virtual", {"yes", "no"}) == "yes";
    } else if (keyword == "compensate") {
      const int first = values(3);
      for (int a = 0; a < D; ++a)
        compensated[a] = number(first + a, "compensate", finite, "finite");
    } else if (keyword == "momentum") {
      momentum_every = utils::inumeric(FLERR, arg[values(1)], false, lmp);
      if (momentum_every < 1)
        error->all(FLERR, "fix mpc: momentum {}: must be positive", arg[i - 1]);
    } else if (keyword == "bins") {
      bins = utils::inumeric(FLERR, arg[values(1)], false, lmp);
      if (bins < 1) error->all(FLERR, "fix mpc: bins {}: must be positive", arg[i - 1]);
    } else if (keyword == "profile") {
      const int first = values(4);
      profile_every = utils::inumeric(FLERR, arg[first], false, lmp);
      profile_frequency = utils::inumeric(FLERR, arg[first + 1], false, lmp);
      if (profile_every < 1 || profile_every % every)
        error->all(FLERR, "fix mpc: profile Nevery {}: must be a multiple of N", arg[first]);
      if (profile_frequency < 1 || profile_frequency % profile_every)
        error->all(FLERR, "fix mpc: profile Nfreq {}: must be a multiple of Nevery",
                   arg[first + 1]);
      profile_append = choice(first + 2, "profile mode", {"file", "append"}) == "append";
      profile_file = arg[first + 3];
    } else if (keyword == "flow") {
      const int first = values(5 + D);
      flow.every = utils::inumeric(FLERR, arg[first], false, lmp);
      flow.frequency = utils::inumeric(FLERR, arg[first + 1], false, lmp);
      if (flow.every < 1 || flow.every % every)
        error->all(FLERR, "fix mpc: flow Nevery {}: must be a multiple of N", arg[first]);
      if (flow.frequency < 1 || flow.frequency % flow.every)
        error->all(FLERR, "fix mpc: flow Nfreq {}: must be a multiple of Nevery", arg[first + 1]);
      double all = 1;
      for (int a = 0; a < D; ++a) {
        flow.bins[a] = utils::inumeric(FLERR, arg[first + 2 + a], false, lmp);
        if (flow.bins[a] < 1)
          error->all(FLERR, "fix mpc: flow {}: bins along {} must be positive",
                     arg[first + 2 + a], "xyz"[a]);
        all *= flow.bins[a];
      }
      if (all > MOST_BINS) error->all(FLERR, "fix mpc: flow: more than {} bins", MOST_BINS);
      if (std::string(arg[first + 2 + D]) != "lab") {
        flow.around = utils::tnumeric(FLERR, arg[first + 2 + D], false, lmp);
        if (flow.around < 1)
          error->all(FLERR, "fix mpc: flow {}: must be lab or the ID of an atom",
                     arg[first + 2 + D]);
      }
      flow.append = choice(first + 3 + D, "flow mode", {"file", "append"}) == "append";
      flow.file = arg[first + 4 + D];
    } else if (keyword == "dump") {
      const int first = values(4);
      dump.every = utils::inumeric(FLERR, arg[first], false, lmp);
      if (dump.every < 1 || dump.every % every)
        error->all(FLERR, "fix mpc: dump Nevery {}: must be a multiple of N", arg[first]);
      dump.one_in = utils::bnumeric(FLERR, arg[first + 1], false, lmp);
      if (dump.one_in < 1)
        error->all(FLERR, "fix mpc: dump M {}: must be positive", arg[first + 1]);
      dump.append = choice(first + 2, "dump mode", {"file", "append"}) == "append";
      dump.file = arg[first + 3];
    } else {
      error->all(FLERR, "fix mpc: unknown keyword {}", keyword);
    }
  }

  if (bins == 0) bins = std::max(1, static_cast<int>(std::lround(2 * domain->prd[1] / edge)));
  if ((particles > 0) == !load_file.empty())
    error->all(FLERR, "fix mpc: one of create and load must be given");
  if (particles != std::round(particles) || particles > mpc::MOST_PARTICLES)
    error->all(FLERR, "fix mpc: create {}: must be a whole number, at most 2^48", particles);
  if (walls && virtual_particles && density == 0)
    error->all(FLERR, "fix mpc: density: needed for the virtual particles of the walls");
  for (const auto &[keyword, given] : std::map<std::string, bool>{{"hydro " + hydro, hydro != "on"},
                                                                  {"reflect", !radii.empty()},
                                                                  {"collide", in_collision}})
    if (given && single)
      error->all(FLERR, "fix mpc: precision single: {} is in double precision only", keyword);
  int pairs = 0;
  for (int a = 0; a < D; ++a) pairs += !domain->periodicity[a];
  if (tstat == "layer" && pairs > 1)
    error->all(FLERR, "fix mpc: tstat layer: there must not be {} pairs of walls", pairs);
  if (D == 3 && axes == mpc::Axes::Coordinate && angle != 90)
    error->all(FLERR, "fix mpc: angle {}: about coordinate axes it must be 90; else use axis random",
               angle);
  if (angle > 180) error->all(FLERR, "fix mpc: angle {}: must be at most 180", angle);
  for (const auto &[keyword, given] : std::map<std::string, bool>{{"force", !interactions.empty()},
                                                                  {"reflect", !radii.empty()},
                                                                  {"collide", in_collision}})
    if (given && !colloid_bit)
      error->all(FLERR, "fix mpc: {}: there is no colloid group", keyword);
  if (!interactions.empty() + !radii.empty() + in_collision > 1)
    error->all(FLERR, "fix mpc: only one of force, reflect and collide can be given");
  if (mpc::square<D>(compensated) > 0 && !colloid_bit)
    error->all(FLERR, "fix mpc: compensate: there is no colloid group");
  if (walls && momentum_every > 0)
    error->all(FLERR, "fix mpc: momentum: walls take up momentum; it is for a periodic box");
}

template struct LAMMPS_NS::MpcArguments<2>;
template struct LAMMPS_NS::MpcArguments<3>;
