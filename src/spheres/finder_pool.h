// One contact finder per thread that asks for one.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include <matstruct/context.h>

#include "base/parallel.h"
#include "spheres/contacts.h"

namespace matstruct {

class FinderPool {
 public:
  FinderPool(const Domain& domain, double smooth_angle) : domain_(domain), smooth_angle_(smooth_angle) {}

  const Domain& domain() const { return domain_; }

  /// parallel_for() whose body is called as body(finder, k) for every k in [0, n).
  template <class Body>
  void for_each(const Context& context, Index n, Index grain, Body body) {
    parallel_for(context, n, grain, [&](Index begin, Index end) {
      std::unique_ptr<ContactFinder> finder = take();
      for (Index k = begin; k < end; ++k) body(*finder, k);
      give_back(std::move(finder));
    });
  }
  /// The same with a single finder, for work in order.
  template <class Body>
  auto with_one(Body body) {
    struct Loan {
      FinderPool& pool;
      std::unique_ptr<ContactFinder> finder;
      ~Loan() { pool.give_back(std::move(finder)); }
    } loan{*this, take()};
    return body(*loan.finder);
  }

 private:
  std::unique_ptr<ContactFinder> take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<ContactFinder>(domain_, smooth_angle_);
    std::unique_ptr<ContactFinder> finder = std::move(idle_.back());
    idle_.pop_back();
    return finder;
  }
  void give_back(std::unique_ptr<ContactFinder> finder) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(finder));
  }

  const Domain& domain_;
  double smooth_angle_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<ContactFinder>> idle_;
};

}  // namespace matstruct
