// Colloids, or monomers, that take part in the collision as particles of their cells, with their
// mass (hecht-2005, section V, 15).
//
// A colloid belongs to one process, its cell perhaps to another: there it is abroad.

#pragma once

#include "coupling.h"

#include <algorithm>
#include <string>

namespace mpc {

template <int D> class CellCoupling : public Coupling<D> {
 public:
  bool feels(int) const override { return true; }
  bool sees_images() const override { return false; }
  bool in_collision() const override { return true; }

  void join(const Grid<D> &grid, const std::vector<Colloid<D>> &colloids, CellSums<D> &sums,
            Processes &processes) override
  {
    impulses_.assign(colloids.size(), {});
    sums.guests.assign(grid.cells(), {});
    at_home_.clear();
    std::vector<Guest> leaving;
    for (std::size_t c = 0; c < colloids.size(); ++c) {
      const auto guest = place(grid, colloids[c], c);
      (grid.local(guest.x) < 0 ? leaving : at_home_).push_back(guest);
    }
    abroad_ = processes.everyones(leaving);
    own_ = leaving.size();
    first_ = 0;    // of its own among those abroad
    while (own_ > 0 && abroad_[first_].id != leaving[0].id) ++first_;

    cells_.clear();
    for (const auto *guests : {&at_home_, &abroad_})
      for (const auto &guest : *guests) {
        cells_.push_back(grid.local(guest.x));
        if (cells_.back() >= 0) sums.add(cells_.back(), guest.v, guest.mass);
      }
  }

  void turn(const Array<Turn<D>> &turns, Processes &processes) override
  {
    auto cell = cells_.begin();
    for (const auto &guest : at_home_)
      impulses_[guest.number()].linear = impulse(guest, turns[*cell++]);
    std::vector<double> impulses(D * abroad_.size());    // each from the process that has the cell
    for (std::size_t k = 0; k < abroad_.size(); ++k, ++cell)
      if (*cell >= 0) {
        const auto of_guest = impulse(abroad_[k], turns[*cell]);
        std::copy(of_guest.begin(), of_guest.end(), &impulses[D * k]);
      }
    processes.sum(impulses.data(), static_cast<int>(impulses.size()));
    for (std::size_t k = first_; k < first_ + own_; ++k)
      std::copy_n(&impulses[D * k], D, impulses_[abroad_[k].number()].linear.begin());
  }

 private:
  using Coupling<D>::impulses_;

  struct Guest {
    double id, index;    // among the colloids of its process
    Vector<D> x, v;
    double mass;

    std::size_t number() const { return static_cast<std::size_t>(index); }
  };

  static Guest place(const Grid<D> &grid, const Colloid<D> &colloid, std::size_t index)
  {
    Guest guest{colloid.id, static_cast<double>(index), {}, colloid.v, colloid.mass};
    for (int a = 0; a < D; ++a) {
      guest.x[a] = wrapped<D>(grid, a, colloid.x[a]);
      if (!(guest.x[a] >= 0 && guest.x[a] <= grid.box[a]))
        throw Fault("colloid " + std::to_string(static_cast<std::int64_t>(colloid.id)) + " has " +
                    "xyz"[a] + " = " + std::to_string(colloid.x[a]) +
                    ": not a number, or beyond a wall");
    }
    return guest;
  }

  static Vector<D> impulse(const Guest &guest, const Turn<D> &turn)
  {
    auto impulse = turn.apply(guest.v);
    for (int a = 0; a < D; ++a) impulse[a] = guest.mass * (impulse[a] - guest.v[a]);
    return impulse;
  }

  std::vector<Guest> at_home_, abroad_;    // its own; those abroad of all processes
  std::vector<int> cells_;                 // of both, -1 for another process's
  std::size_t first_ = 0, own_ = 0;
};

}    // namespace mpc
