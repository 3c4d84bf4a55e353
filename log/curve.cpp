#include "curve.h"

#include <algorithm>
#include <cmath>

namespace musclesim {

namespace {

/// Collects points and thins them out, one pixel column after another.
class Thinner {
 public:
  void add(SvgPoint point) {
    const double column = std::floor(point.x);
    if (count_ > 0 && column != column_) finishColumn();
    column_ = column;
    if (count_ == 0 || point.y < lowest_.y) {
      lowest_ = point;
      lowest_order_ = count_;
    }
    if (count_ == 0 || point.y > highest_.y) {
      highest_ = point;
      highest_order_ = count_;
    }
    ++count_;
  }

  void finishPiece() {
    finishColumn();
    if (!piece_.empty()) pieces_.push_back(std::move(piece_));
    piece_.clear();
  }

  std::vector<std::vector<SvgPoint>> pieces_;

 private:
  void finishColumn() {
    if (count_ == 0) return;
    const bool lowest_first = lowest_order_ <= highest_order_;
    piece_.push_back(lowest_first ? lowest_ : highest_);
    if (lowest_order_ != highest_order_) piece_.push_back(lowest_first ? highest_ : lowest_);
    count_ = 0;
  }

  std::vector<SvgPoint> piece_;
  SvgPoint lowest_, highest_;
  std::size_t count_ = 0, lowest_order_ = 0, highest_order_ = 0;
  double column_ = 0;
};

}  // namespace

std::vector<std::vector<SvgPoint>> curvePieces(const std::vector<double>& time_s, const std::vector<double>& values, const Axis& time_axis,
                                               const Axis& value_axis, Between between) {
  Thinner thinner;
  double last_y = std::nan("");
  for (std::size_t i = 0; i < std::min(time_s.size(), values.size()); ++i) {
    if (std::isnan(values[i])) {
      thinner.finishPiece();
      last_y = std::nan("");
      continue;
    }
    const SvgPoint point{time_axis.pixel(time_s[i]), value_axis.pixel(values[i])};
    const bool has_step = between == Between::held && !std::isnan(last_y) && last_y != point.y;
    if (has_step) thinner.add({point.x, last_y});
    thinner.add(point);
    last_y = point.y;
  }
  thinner.finishPiece();
  return std::move(thinner.pieces_);
}

}  // namespace musclesim
