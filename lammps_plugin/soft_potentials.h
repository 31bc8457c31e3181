// Pair potentials as functions of the squared distance w = r^2, with three derivatives.
//
// u(w) = phi(r). Then, without a square root: phi'/r = 2u', (phi'' - phi'/r)/r^2 = 4u'', and in D
// dimensions the Laplacian phi'' + (D-1) phi'/r = 4w u'' + 2D u' with its gradient along r,
// [(8 + 4D) u'' + 8w u'''] r.

#pragma once

#include <cmath>
#include <string>

namespace soft {

struct Series {
  double u, u1, u2, u3;    // u and its derivatives by w
};

// epsilon (sigma/r)^12 (delhommelle-2005, II)
struct InverseTwelve {
  static constexpr const char *name = "soft/disk";
  static constexpr bool own_cutoff = false;    // given by the user

  double c12 = 0;

  static InverseTwelve make(double epsilon, double sigma)
  {
    return {epsilon * std::pow(sigma, 12)};
  }
  static double cutoff(double) { return 0; }

  double slope(double w) const    // u', with the roundings of series()
  {
    const double i = 1 / w, i2 = i * i, i4 = i2 * i2, u = c12 * i4 * i2;
    return -6 * u * i;
  }
  Series series(double w) const
  {
    const double i = 1 / w, i2 = i * i, i4 = i2 * i2, u = c12 * i4 * i2;
    return {u, -6 * u * i, 42 * u * i2, -336 * u * i2 * i};
  }
};

// epsilon (1 - 4 [(sigma/r)^6 - (sigma/r)^12]) within 2^(1/6) sigma (delhommelle-2005, II)
struct WeeksChandlerAndersen {
  static constexpr const char *name = "wca";
  static constexpr bool own_cutoff = true;

  double epsilon = 0, c6 = 0, c12 = 0;

  static WeeksChandlerAndersen make(double epsilon, double sigma)
  {
    return {epsilon, 4 * epsilon * std::pow(sigma, 6), 4 * epsilon * std::pow(sigma, 12)};
  }
  static double cutoff(double sigma) { return std::pow(2.0, 1.0 / 6) * sigma; }

  double slope(double w) const
  {
    const double i = 1 / w, i2 = i * i, i3 = i2 * i;
    const double six = c6 * i3, twelve = c12 * i3 * i3;
    return (3 * six - 6 * twelve) * i;
  }
  Series series(double w) const
  {
    const double i = 1 / w, i2 = i * i, i3 = i2 * i;
    const double six = c6 * i3, twelve = c12 * i3 * i3;
    return {epsilon - six + twelve, (3 * six - 6 * twelve) * i, (42 * twelve - 12 * six) * i2,
            (60 * six - 336 * twelve) * i3};
  }
};

}    // namespace soft
