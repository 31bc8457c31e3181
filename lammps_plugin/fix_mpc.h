// fix mpc: a multi-particle collision fluid in LAMMPS (docs/fix_mpc.md). The fluid is in core/;
// this adapter gives it its parameters and the clock.

#pragma once

#include "fix.h"

#include "core/solver.h"
#include "mpc_arguments.h"
#include "mpc_colloids.h"
#include "mpc_dump.h"
#include "mpc_flow.h"
#include "mpc_profile.h"
#include "mpc_restart.h"
#include "mpc_state.h"
#include "mpi_processes.h"

#include <memory>
#include <vector>

namespace LAMMPS_NS {

template <int D> class FixMPC : public Fix {
 public:
  FixMPC(LAMMPS *, int, char **);
  int setmask() override;
  void init() override;
  void setup_pre_reverse(int, int) override;
  void setup(int) override;
  void initial_integrate(int) override;
  void pre_reverse(int, int) override;
  void end_of_step() override;

  double compute_scalar() override;
  double compute_vector(int) override;
  double compute_array(int, int) override;
  double memory_usage() override;
  int modify_param(int, char **) override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  int pack_forward_comm(int, int *, double *, int, int *) override;
  void unpack_forward_comm(int, int, double *) override;
  int pack_reverse_comm(int, int, double *) override;
  void unpack_reverse_comm(int, int *, double *) override;

 private:
  void make_solver(double particles);
  std::unique_ptr<mpc::Coupling<D>> make_coupling(const mpc::Vector<D> &field,
                                                  const mpc::Walls<D> *) const;
  mpc::Coupling<D> *coupling() { return solver_->coupling(); }
  MpcFluidFile<D> fluid_file() { return {lmp, *solver_, *state_, processes_}; }
  bool couples_every_step() { return coupling() && coupling()->every_step(); }
  void check_processes();
  void remove_momentum();
  void dump();
  void add_forces(bool moving);
  template <class Action> void guarded(const Action &);
  const std::vector<mpc::Layer> &layers();
  const mpc::Moments<D> &moments();
  const mpc::Vector<D> &momentum();
  const mpc::FaceVectors<D> &momentum_of_walls();

  const MpcArguments<D> given_;
  MpiProcesses processes_;
  MpcColloids<D> colloids_;
  std::unique_ptr<MpcProfile> profile_;    // or none
  std::unique_ptr<MpcFlow<D>> flow_;       // or none
  std::unique_ptr<MpcDump<D>> dump_;       // or none
  std::unique_ptr<mpc::AnySolver<D>> solver_;
  std::unique_ptr<MpcState<D>> state_;
  double interval_ = 0;
  bool open_ = false;        // within an interval
  bool restored_ = false;    // from a restart, not yet gone on
  bool looked_ = false;      // for what the fluid does not feel
  bool begun_ = false;       // the dump has its first frame

  std::vector<mpc::Layer> layers_;
  mpc::Moments<D> moments_;
  mpc::Vector<D> momentum_{};
  mpc::FaceVectors<D> momentum_of_walls_{};
  bigint layers_step_ = -1, moments_step_ = -1, momentum_step_ = -1, walls_step_ = -1;    // of each
};

}    // namespace LAMMPS_NS
