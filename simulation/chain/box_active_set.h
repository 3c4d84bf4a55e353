/// Which bounded rows stick and which are at a bound: the active set of a box-constrained problem.
///
/// Find forces l with  w = A l - b  and, row by row,  lower <= l <= upper,
///     l free: w = 0,   l = lower: w >= 0,   l = upper: w <= 0.
/// A is symmetric positive definite, so there is exactly one solution: the minimum of 1/2 l^T A l - b^T l over the box.
/// Rows without bounds are no rows here: the problem eliminates them.
#pragma once

#include <vector>

namespace musclesim::chain {

enum class RowState : signed char { free, at_lower, at_upper };

struct BoundedRow {
  double lower = 0, upper = 0;
  double diagonal = 1;  ///< of A, or an estimate: tells whether a violation reaches beyond the other bound
  RowState state = RowState::free;
  double force = 0;     ///< l: given by solve() for free rows, the bound for others
  double slack = 0;     ///< w: given by solve() for rows at a bound
  int group = 0;        ///< 0, 1, ...: rows of one group act on each other strongly
  double feasible = 0;  ///< l of the present point within the box, used by the monotone phase

  double bound() const { return state == RowState::at_lower ? lower : upper; }
};

/// The problem behind the rows.
class BoxProblem {
 public:
  virtual ~BoxProblem() = default;
  /// For the rows' present states: the forces of the free rows (w = 0) and the slacks of the others.
  virtual void solve(std::vector<BoundedRow>& rows) = 0;
  /// Row `row` has got another state since the last solve().
  virtual void changed(int row) = 0;
  /// What counts as zero, after solve().
  virtual double forceTolerance() const = 0;
  virtual double slackTolerance() const = 0;
};

struct ActiveSetResult {
  bool solved = false;
  int rounds = 0;           ///< calls of solve()
  int monotone_rounds = 0;  ///< of them in the monotone phase
};

/// Phase 1, primal-dual: all rows that violate their condition change their state in the first rounds, then only the worst of every group;
/// a row at a bound whose violation reaches beyond the whole box goes to the other bound. Starts from the rows' states, so states of the
/// step before make it short. It may cycle, so after `patience` rounds without progress phase 2 takes over: from a point within the box
/// towards the minimum for the present set, up to the first bound met (where that row stays); rows are released only at such a minimum. The
/// objective falls all the time: it ends.
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
  std::vector<Worst> worst_;  ///< by group
};

}  // namespace musclesim::chain
