/// Targets over time, from a table.
#pragma once

#include <string>
#include <vector>

namespace musclesim {

/// Targets of joint angles and of the hand's height over time, on straight lines between the rows; before the first row and after the last
/// these rows hold.
class TargetTable {
 public:
  /// Reads time_s and the columns angle_<joint>_deg, target_<joint>_deg, hand_y_mm and target_y_mm of a table or of a recording; other
  /// columns that a recording may have are skipped. Throws BadFile for anything else and for missing values, IoError.
  explicit TargetTable(const std::string& csv_file);

  /// The target of a joint, degrees, or of the hand's height, mm, for an empty name. Columns target_... go before columns of readings.
  /// Throws BadFile if the table does not have it.
  std::vector<double> column(const std::string& joint) const;
  /// The value of a column at a time.
  double at(const std::vector<double>& column, double time_s) const;
  double endS() const { return time_s_.back(); }

 private:
  std::string file_;
  std::vector<double> time_s_;
  std::vector<std::pair<std::string, std::vector<double>>> columns_;  ///< by canonical name
};

}  // namespace musclesim
