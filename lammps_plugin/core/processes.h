// What the solver asks of the processes it shares the box with.

#pragma once

#include <vector>

namespace mpc {

// Alone in the box; a parallel host overrides all.
struct Processes {
  virtual ~Processes() = default;

  // Neighbours along an axis, counting itself.
  virtual int along(int /*axis*/) const { return 1; }

  // Sum over all processes, in place.
  virtual void sum(double * /*values*/, int /*count*/) {}

  virtual bool any(bool mine) { return mine; }

  // Hand values to the two neighbours along an axis; what they hand to this process.
  virtual std::vector<double> trade(int /*axis*/, const std::vector<double> & /*to_lower*/,
                                    const std::vector<double> & /*to_upper*/)
  {
    return {};
  }
};

}    // namespace mpc
