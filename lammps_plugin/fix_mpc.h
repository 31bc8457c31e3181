// fix mpc: a multi-particle collision fluid in LAMMPS (docs/fix_mpc.md). The fluid is in core/;
// this adapter gives it its parameters, the colloids, the clock and the files.

#pragma once

#include "fix.h"

#include "core/profile.h"
#include "core/solver.h"
#include "mpc_arguments.h"
#include "mpi_processes.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

template <int D> class FixMPC : public Fix {
 public:
  FixMPC(LAMMPS *, int, char **);
  ~FixMPC() override;
  int setmask() override;
  void init() override;
  void setup_pre_reverse(int, int) override;
  void initial_integrate(int) override;
  void pre_reverse(int, int) override;
  void final_integrate() override;
  void end_of_step() override;

  double compute_scalar() override;
  double compute_vector(int) override;
  double compute_array(int, int) override;
  double memory_usage() override;
  int modify_param(int, char **) override;
  void write_restart(FILE *) override;
  void restart(char *) override;

 private:
  // What this process's fluid did to a colloid or image at the last collision step.
  struct Pull {
    double process, id;
    mpc::Vector<D> x, force;
  };

  void open_profile();
  void make_solver();
  void create_fluid();
  void load_fluid();
  void save_fluid(const std::string &);
  mpc::FluidHeader fluid_header() const;
  std::array<int, D> bound(const double *) const;
  std::array<int, D> lower() const;
  std::array<int, D> upper() const;

  void snapshot();
  void read_colloids();
  int atom_at(double, const mpc::Vector<D> &, double) const;
  void remember_pulls();
  bool repeat_pulls();
  void add_forces();
  template <class Action> void guarded(const Action &);

  const std::vector<mpc::Layer> &profile();
  void write_profile();
  template <class Visit> void gather(const Visit &);
  template <class T> std::vector<T> everyones(const std::vector<T> &) const;

  const MpcArguments<D> given_;
  FILE *profile_file_ = nullptr;

  MpiProcesses processes_;
  std::unique_ptr<mpc::Solver<D>> solver_;
  double interval_ = 0;

  // colloids and their images that this process sees, in the order of the beginning of the interval
  std::vector<mpc::Colloid<D>> slots_;
  std::vector<int> atoms_;    // index of each slot's atom; -1 when it left the ghosts
  std::vector<mpc::Vector<D>> forces_;
  std::vector<Pull> pulls_;
  double colloid_speed_ = 0;
  bool open_ = false;         // within an interval

  std::vector<mpc::Layer> layers_, averaged_;
  bigint layers_step_ = -1;
  int looks_ = 0;
};

}    // namespace LAMMPS_NS
