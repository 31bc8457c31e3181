// Sums over many particles. Numbers added to one sum wait for each other: here each goes to the sum
// of a lane, and processors add to several lanes at once.

#pragma once

#include <array>

namespace mpc {

// Of the terms 0 ... count - 1, each with N numbers.
template <int N, class Term> std::array<double, N> sum_in_lanes(int count, const Term &term)
{
  constexpr int LANES = 16;
  double lanes[N][LANES]{};
  const int whole = count - count % LANES;
  for (int i = 0; i < whole; i += LANES)
    for (int lane = 0; lane < LANES; ++lane) {
      const std::array<double, N> terms = term(i + lane);
      for (int n = 0; n < N; ++n) lanes[n][lane] += terms[n];
    }
  std::array<double, N> sums{};
  for (int n = 0; n < N; ++n)
    for (int lane = 0; lane < LANES; ++lane) sums[n] += lanes[n][lane];
  for (int i = whole; i < count; ++i) {
    const std::array<double, N> terms = term(i);
    for (int n = 0; n < N; ++n) sums[n] += terms[n];
  }
  return sums;
}

}    // namespace mpc
