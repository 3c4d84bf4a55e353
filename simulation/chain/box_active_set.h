/// Active set of a box-constrained problem: decides which bounded rows are free and which are at a bound.
///
/// Find forces l with  w = A l - b  and, row by row,  lower <= l <= upper,
///     l free: w = 0,   l = lower: w >= 0,   l = upper: w <= 0.
/// A is symmetric positive definite, so there is exactly one solution: the minimum of 1/2 l^T A l - b^T l over the box.
/// Rows without bounds do not appear here: the BoxProblem eliminates them.
#pragma once

#include <vector>

namespace musclesim::chain {

enum class RowState : signed char { free, at_lower, at_upper };

struct BoundedRow {
  double lower = 0, upper = 0;
  double diagonal = 1;  ///< diagonal entry of A or an estimate of it; tells whether a violation reaches beyond the other bound
  RowState state = RowState::free;
  double force = 0;     ///< l: solve() computes it for free rows; for other rows it is the bound
  double slack = 0;     ///< w: solve() computes it for rows at a bound
  int group = 0;        ///< 0, 1, ...: rows of the same group are strongly coupled
  double feasible = 0;  ///< l at the monotone phase's current point, which lies within the box

  double bound() const { return state == RowState::at_lower ? lower : upper; }
};

/// The linear system that the rows belong to.
class BoxProblem {
 public:
  virtual ~BoxProblem() = default;
  /// Computes, for the present states, the forces of the free rows (w = 0) and the slacks of the rows at a bound.
  virtual void solve(std::vector<BoundedRow>& rows) = 0;
  /// Tells the problem that the state of `row` has changed since the last solve().
  virtual void changed(int row) = 0;
  /// Thresholds below which a force or a slack counts as zero. Valid after solve().
  virtual double forceTolerance() const = 0;
  virtual double slackTolerance() const = 0;
};

struct ActiveSetResult {
  bool solved = false;
  int rounds = 0;           ///< calls of solve()
  int monotone_rounds = 0;  ///< calls of solve() in the monotone phase
};

/// Phase 1, primal-dual: in the first rounds every row that violates its condition changes its state, later only the worst row of each
/// group. A row at a bound whose violation reaches beyond the whole box goes to the other bound. The phase starts from the rows' states, so
/// it is short if these come from the previous step. It may cycle; after `patience` rounds without progress phase 2 takes over. Phase 2,
/// monotone: moves from a point within the box towards the minimum for the present active set and stops at the first bound it meets, where
/// that row stays. Rows are released only at such a minimum. The objective decreases in every round, so the phase ends.
class BoxActiveSet {
 public:
  BoxActiveSet() { worst_.reserve(256); }
  int full_rounds = 4, most_rounds = 60, patience = 15, most_monotone_rounds = 400;
  ActiveSetResult run(BoxProblem& problem, std::vector<BoundedRow>& rows);

 private:
  bool primalDual(BoxProblem& problem, std::vector<BoundedRow>& rows, ActiveSetResult& result);
  bool monotone(BoxProblem& problem, std::vector<BoundedRow>& rows, ActiveSetResult& result) const;
  int changeAll(BoxProblem& problem, std::vector<BoundedRow>& rows) const;
  int changeWorst(BoxProblem& problem, std::vector<BoundedRow>& rows);

  struct Worst {
    int row = -1;
    double violation = 0;
    RowState demanded = RowState::free;
  };
  std::vector<Worst> worst_;  ///< one per group
};

}  // namespace musclesim::chain
