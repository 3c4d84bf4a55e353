#include "matlab.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <matio.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <tuple>

#include "../base/apart.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/text.h"
#include "musclesim/log/csv.h"

namespace musclesim {

namespace {

struct MatlabColumn {
  std::string name;
  std::vector<double> values;
};

template <class Number>
double element(const void* data, std::size_t i) {
  return static_cast<double>(static_cast<const Number*>(data)[i]);
}

/// Reads an element of an array of this type; nothing if it is no array of numbers.
double (*elementReader(matio_types type))(const void*, std::size_t) {
  switch (type) {
    case MAT_T_DOUBLE:
      return element<double>;
    case MAT_T_SINGLE:
      return element<float>;
    case MAT_T_INT8:
      return element<std::int8_t>;
    case MAT_T_UINT8:
      return element<std::uint8_t>;
    case MAT_T_INT16:
      return element<std::int16_t>;
    case MAT_T_UINT16:
      return element<std::uint16_t>;
    case MAT_T_INT32:
      return element<std::int32_t>;
    case MAT_T_UINT32:
      return element<std::uint32_t>;
    case MAT_T_INT64:
      return element<std::int64_t>;
    case MAT_T_UINT64:
      return element<std::uint64_t>;
    default:
      return nullptr;
  }
}

std::unique_ptr<mat_t, int (*)(mat_t*)> opened(const std::string& file) {
  std::unique_ptr<mat_t, int (*)(mat_t*)> mat(Mat_Open(file.c_str(), MAT_ACC_RDONLY), Mat_Close);
  if (!mat) throw BadFile(file, "is not a MATLAB file of version 5 to 7.3 (an older one, a damaged one, or another format?)");
  return mat;
}

using Variable = std::unique_ptr<matvar_t, void (*)(matvar_t*)>;

/// Refuses a file whose arrays would need more memory by their heads alone, before any of them is inflated. Fields of structures have no
/// heads here.
void requireRoom(const std::string& file, std::size_t memory_bytes) {
  constexpr double bytes_per_element = 2 * sizeof(double);  // as libmatio reads it, and as a column
  const auto mat = opened(file);
  double bytes = 0;
  while (const Variable head{Mat_VarReadNextInfo(mat.get()), Mat_VarFree}) {
    double elements = 1;
    for (int i = 0; i < head->rank; ++i) elements *= static_cast<double>(head->dims[i]);
    bytes += head->class_type == MAT_C_STRUCT || head->class_type == MAT_C_CELL ? 0 : bytes_per_element * elements;
  }
  if (bytes > static_cast<double>(memory_bytes))
    throw BadFile(file,
                  fmt::format("says that its arrays need {:.3g} MB of memory, more than a file of its size should", bytes / (1 << 20)));
}

/// Collects the columns of all arrays of numbers of a file.
class Columns {
 public:
  explicit Columns(const std::string& file) : file_(file) {
    const auto mat = opened(file);
    while (const auto variable = next(mat.get())) add(variable->name ? variable->name : "", *variable);
  }
  std::vector<MatlabColumn> columns;
  std::vector<std::string> unreadable;  ///< names of what holds no real numbers
  bool has_objects = false;             ///< beside texts

 private:
  std::string file_;
  static Variable next(mat_t* mat) { return {Mat_VarReadNext(mat), Mat_VarFree}; }

  void add(const std::string& name, matvar_t& variable) {
    if (variable.class_type == MAT_C_STRUCT) return addFields(name, variable);
    const auto read = variable.class_type == MAT_C_CHAR ? nullptr : elementReader(variable.data_type);
    std::vector<std::size_t> sides;
    for (int i = 0; i < variable.rank; ++i)
      if (variable.dims[i] != 1) sides.push_back(variable.dims[i]);
    if (!variable.data && std::ranges::count(sides, 0u) == 0 && read)
      throw BadFile(file_, fmt::format("the values of {} cannot be read: the file is cut, damaged, or holds more than its size allows",
                                       inQuotes(name)));
    if (sides.size() > 2 || variable.isComplex || !variable.data || !read || variable.class_type == MAT_C_SPARSE) {
      unreadable.push_back(name);
      has_objects = has_objects || variable.class_type != MAT_C_CHAR;
      return;
    }
    sides.resize(2, 1);
    addArray(name, sides[0], sides[1], [&](std::size_t i) { return read(variable.data, i); });
  }

  void addFields(const std::string& name, matvar_t& structure) {
    std::size_t count = 1;
    for (int i = 0; i < structure.rank; ++i) count *= structure.dims[i];
    const unsigned field_count = Mat_VarGetNumberOfFields(&structure);
    const auto names = Mat_VarGetStructFieldnames(&structure);
    for (std::size_t i = 0; i < count; ++i)
      for (unsigned field = 0; field < field_count; ++field)
        if (matvar_t* value = Mat_VarGetStructFieldByIndex(&structure, field, i))
          add(count == 1 ? fmt::format("{}.{}", name, names[field]) : fmt::format("{}({}).{}", name, i + 1, names[field]), *value);
  }

  /// The samples of a matrix run along its longer side.
  void addArray(const std::string& name, std::size_t rows, std::size_t row_length, const std::function<double(std::size_t)>& read) {
    const bool is_upright = rows >= row_length;
    const std::size_t length = std::max(rows, row_length), count = std::min(rows, row_length);
    for (std::size_t c = 0; c < count; ++c) {
      MatlabColumn column{name, {}};
      if (count > 1) column.name = is_upright ? fmt::format("{}(:,{})", name, c + 1) : fmt::format("{}({},:)", name, c + 1);
      column.values.reserve(length);
      for (std::size_t i = 0; i < length; ++i) column.values.push_back(read(is_upright ? c * rows + i : i * rows + c));
      columns.push_back(std::move(column));
    }
  }
};

/// The length that most columns have, of two such lengths the longer; scalars count only if there is nothing else.
std::size_t usualLength(const std::vector<MatlabColumn>& columns) {
  std::map<std::size_t, int> counts;
  for (const MatlabColumn& column : columns) ++counts[column.values.size()];
  const auto rank = [](const auto& entry) { return std::tuple(entry.first > 1, entry.second, entry.first); };
  return std::ranges::max_element(counts, {}, rank)->first;
}

std::size_t lengthOf(const std::string& variable, const std::vector<MatlabColumn>& columns, const std::string& file) {
  const auto found = std::ranges::find(columns, variable, &MatlabColumn::name);
  if (found != columns.end()) return found->values.size();
  std::vector<std::string> names;
  for (const MatlabColumn& column : columns) names.push_back(column.name);
  throw BadFile(file, fmt::format("has no array {}; it has {}", inQuotes(variable), fmt::join(names, ", ")));
}

std::string tableText(const std::vector<const MatlabColumn*>& columns, std::size_t length) {
  std::string text;
  for (const MatlabColumn* column : columns) text += fmt::format("{}\"{}\"", text.empty() ? "" : ",", column->name);
  for (std::size_t row = 0; row < length; ++row) {
    text += '\n';
    for (const MatlabColumn* column : columns) {
      if (column != columns.front()) text += ',';
      if (!std::isnan(column->values[row])) text += fmt::format("{}", column->values[row]);
    }
  }
  return text + "\n";
}

}  // namespace

bool isMatlabFile(const std::string& file) {
  return file.ends_with(".mat");
}

namespace {

std::string tableOf(const std::string& file, const std::string& variable, std::vector<std::string>& notes) {
  const Columns all(file);
  if (all.columns.empty()) throw BadFile(file, "has no array of real numbers");
  const std::size_t length = variable.empty() ? usualLength(all.columns) : lengthOf(variable, all.columns, file);
  std::vector<const MatlabColumn*> columns;
  std::vector<std::string> others;
  for (const MatlabColumn& column : all.columns)
    if (column.values.size() == length)
      columns.push_back(&column);
    else
      others.push_back(fmt::format("{} ({})", column.name, column.values.size()));
  if (!others.empty())
    notes.push_back(
        fmt::format("{}: the table has the {} arrays of length {}; of other length: {} (variable in the mapping's [table] chooses)", file,
                    columns.size(), length, fmt::join(others, ", ")));
  if (!all.unreadable.empty())
    notes.push_back(fmt::format("{}: holds no real numbers that can be read: {}{}", file, fmt::join(all.unreadable, ", "),
                                all.has_objects ? " (objects such as timeseries must be saved as plain arrays)" : ""));
  return tableText(columns, length);
}

/// A file of a few kilobytes can stand for gigabytes of zeros. Reading takes about 8 times the bytes of a file that is not compressed; the
/// rest is for compression, up to 5 : 1 in large files and any in small ones.
ApartLimits limitsFor(std::size_t file_bytes) {
  constexpr std::size_t least_bytes = std::size_t{128} << 20, per_byte = 40, bytes_per_s = std::size_t{1} << 20;
  return {least_bytes + per_byte * file_bytes, static_cast<unsigned>(1 + file_bytes / bytes_per_s)};
}

}  // namespace

std::string matlabTable(const std::string& file, const std::string& variable, std::vector<std::string>& notes) {
  const std::size_t file_bytes = readTextFile(file, CsvLimits().file_bytes).size();  // says why a file cannot be read
  // The notes come first, each ended by a zero byte, and one more ends them.
  const ApartLimits limits = limitsFor(file_bytes);
  const std::string answer = doApart(file, limits, [&] {
    requireRoom(file, limits.memory_bytes);
    std::vector<std::string> own_notes;
    const std::string table = tableOf(file, variable, own_notes);
    std::string all;
    for (const std::string& note : own_notes) all += note + '\0';
    return all + '\0' + table;
  });
  std::size_t at = 0;
  for (std::size_t end = answer.find('\0'); end != at; end = answer.find('\0', at)) {
    notes.push_back(answer.substr(at, end - at));
    at = end + 1;
  }
  return answer.substr(at + 1);
}

}  // namespace musclesim
