// What the solver asks of the processes it shares the box with.

#pragma once

#include <cstring>
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

  // Records of all processes on all, process by process; for the few that colloids are.
  template <class Record> std::vector<Record> everyones(const std::vector<Record> &mine)
  {
    const auto *bytes = reinterpret_cast<const char *>(mine.data());
    const auto all = gather({bytes, bytes + mine.size() * sizeof(Record)});
    std::vector<Record> records(all.size() / sizeof(Record));
    if (!all.empty()) std::memcpy(static_cast<void *>(records.data()), all.data(), all.size());
    return records;
  }

  // Sum over the images of each colloid that the host sees, on all processes, in place: so many
  // values for each.
  virtual void sum_images(std::vector<double> & /*values*/, int /*width*/) {}

 protected:
  virtual std::vector<char> gather(const std::vector<char> &mine) { return mine; }
};

}    // namespace mpc
