#include <matstruct/error.h>
#include <matstruct/options.h>

#include <fmt/format.h>

namespace matstruct {

namespace {

void require_in(const char* name, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw Error(fmt::format("option {} is {}; it must be between {} and {}.", name, value, low, high));
}

}  // namespace

void Options::validate() const {
  require_in("gamma", gamma, 2, 1000);
  require_in("convex_angle", convex_angle, 1e-3, 179.999);
  require_in("concave_angle", concave_angle, 1e-3, 179.999);
  require_in("thinning", thinning, 0, 1);
  require_in("deviation", deviation, 1e-3, 100);
  require_in("refinements", refinements, 0, 100);
  require_in("particle_rounds", particle_rounds, 0, 1000);
  require_in("particle_change", particle_change, 0, 1);
  require_in("particle_gradient", particle_gradient, 1e-6, 1);
  require_in("max_rounds", max_rounds, 0, 100000);
  require_in("samples", samples, 1000, 1e8);
  require_in("threads", threads, 0, 4096);
}

}  // namespace matstruct
