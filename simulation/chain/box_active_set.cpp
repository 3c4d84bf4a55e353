#include "box_active_set.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace musclesim::chain {

namespace {

/// The state that the row's complementarity condition requires.
RowState demanded(const BoundedRow& row, double force_tolerance, double slack_tolerance) {
  switch (row.state) {
    case RowState::free:
      if (row.force < row.lower - force_tolerance) return RowState::at_lower;
      if (row.force > row.upper + force_tolerance) return RowState::at_upper;
      return RowState::free;
    case RowState::at_lower:
      if (row.slack >= -slack_tolerance) return RowState::at_lower;
      return row.lower - row.slack / row.diagonal > row.upper ? RowState::at_upper : RowState::free;
    case RowState::at_upper:
      if (row.slack <= slack_tolerance) return RowState::at_upper;
      return row.upper - row.slack / row.diagonal < row.lower ? RowState::at_lower : RowState::free;
  }
  return row.state;
}

/// By how much the row violates its condition, as a force.
double violationOf(const BoundedRow& row) {
  if (row.state == RowState::free) return std::max(row.lower - row.force, row.force - row.upper);
  return std::abs(row.slack) / row.diagonal;
}

void change(BoxProblem& problem, std::vector<BoundedRow>& rows, std::size_t i, RowState state) {
  rows[i].state = state;
  if (state != RowState::free) rows[i].force = rows[i].bound();
  problem.changed(static_cast<int>(i));
}

/// Largest step, up to 1, from the feasible point towards the free rows' forces that stays within the box.
double stepWithin(const std::vector<BoundedRow>& rows, double tolerance) {
  double step = 1;
  for (const BoundedRow& row : rows) {
    if (row.state != RowState::free) continue;
    const double way = row.force - row.feasible;
    if (row.force > row.upper + tolerance) step = std::min(step, std::max(0.0, (row.upper - row.feasible) / way));
    if (row.force < row.lower - tolerance) step = std::min(step, std::max(0.0, (row.lower - row.feasible) / way));
  }
  return step;
}

/// Moves the feasible point; rows that reach a bound stay there.
void moveWithin(BoxProblem& problem, std::vector<BoundedRow>& rows, double step, double tolerance) {
  constexpr double rounding = 1e-12;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    BoundedRow& row = rows[i];
    if (row.state != RowState::free) continue;
    const double target = row.feasible + step * (row.force - row.feasible);
    if (row.force > row.upper + tolerance && target >= row.upper - rounding * (std::abs(row.upper) + tolerance)) {
      change(problem, rows, i, RowState::at_upper);
      row.feasible = row.upper;
    } else if (row.force < row.lower - tolerance && target <= row.lower + rounding * (std::abs(row.lower) + tolerance)) {
      change(problem, rows, i, RowState::at_lower);
      row.feasible = row.lower;
    } else {
      row.feasible = std::clamp(target, row.lower, row.upper);
    }
  }
}

/// Frees all rows whose slack points into the box. Returns their number.
int release(BoxProblem& problem, std::vector<BoundedRow>& rows, double tolerance) {
  int count = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const BoundedRow& row = rows[i];
    const bool inward =
        (row.state == RowState::at_lower && row.slack < -tolerance) || (row.state == RowState::at_upper && row.slack > tolerance);
    if (!inward) continue;
    change(problem, rows, i, RowState::free);
    ++count;
  }
  return count;
}

}  // namespace

ActiveSetResult BoxActiveSet::run(BoxProblem& problem, std::vector<BoundedRow>& rows) {
  ActiveSetResult result;
  for (BoundedRow& row : rows)
    if (row.state != RowState::free) row.force = row.bound();
  result.solved = primalDual(problem, rows, result) || monotone(problem, rows, result);
  return result;
}

/// Returns the number of rows that violate their condition.
int BoxActiveSet::changeAll(BoxProblem& problem, std::vector<BoundedRow>& rows) const {
  const double force_tolerance = problem.forceTolerance(), slack_tolerance = problem.slackTolerance();
  int count = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RowState state = demanded(rows[i], force_tolerance, slack_tolerance);
    if (state == rows[i].state) continue;
    change(problem, rows, i, state);
    ++count;
  }
  return count;
}

/// Returns the number of rows that violate their condition.
int BoxActiveSet::changeWorst(BoxProblem& problem, std::vector<BoundedRow>& rows) {
  const double force_tolerance = problem.forceTolerance(), slack_tolerance = problem.slackTolerance();
  worst_.clear();
  int count = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RowState state = demanded(rows[i], force_tolerance, slack_tolerance);
    if (state == rows[i].state) continue;
    ++count;
    const auto group = static_cast<std::size_t>(rows[i].group);
    if (worst_.size() <= group) worst_.resize(group + 1);
    const double violation = violationOf(rows[i]);
    if (worst_[group].row < 0 || violation > worst_[group].violation) worst_[group] = {static_cast<int>(i), violation, state};
  }
  for (const Worst& worst : worst_)
    if (worst.row >= 0) change(problem, rows, static_cast<std::size_t>(worst.row), worst.demanded);
  return count;
}

bool BoxActiveSet::primalDual(BoxProblem& problem, std::vector<BoundedRow>& rows, ActiveSetResult& result) {
  int fewest = std::numeric_limits<int>::max(), rounds_without_progress = 0;
  while (result.rounds < most_rounds && rounds_without_progress < patience) {
    ++result.rounds;
    problem.solve(rows);
    const int violations = result.rounds <= full_rounds ? changeAll(problem, rows) : changeWorst(problem, rows);
    if (violations == 0) return true;
    rounds_without_progress = violations < fewest ? 0 : rounds_without_progress + 1;
    fewest = std::min(fewest, violations);
  }
  return false;
}

bool BoxActiveSet::monotone(BoxProblem& problem, std::vector<BoundedRow>& rows, ActiveSetResult& result) const {
  for (BoundedRow& row : rows) row.feasible = std::clamp(row.force, row.lower, row.upper);
  while (result.monotone_rounds < most_monotone_rounds) {
    ++result.monotone_rounds;
    ++result.rounds;
    problem.solve(rows);
    const double step = stepWithin(rows, problem.forceTolerance());
    moveWithin(problem, rows, step, problem.forceTolerance());
    if (step < 1) continue;
    if (release(problem, rows, problem.slackTolerance()) == 0) return true;
  }
  return false;
}

}  // namespace musclesim::chain
