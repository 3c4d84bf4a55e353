#include "plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>
#include <set>

#include "../base/toml_document.h"
#include "musclesim/base/error.h"
#include "plan_values.h"

namespace musclesim {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t largest_seed = 1'000'000'000'000;

using RowParameters = std::vector<std::pair<std::string, Parameter::Value>>;

/// Every combination of two sets of rows.
std::vector<RowParameters> combined(const std::vector<RowParameters>& outer, const std::vector<RowParameters>& inner) {
  std::vector<RowParameters> all;
  for (const auto& first : outer)
    for (const auto& second : inner) {
      all.push_back(first);
      all.back().insert(all.back().end(), second.begin(), second.end());
    }
  return all;
}

/// A permutation of 0 .. count - 1 (Fisher and Yates, 1938).
std::vector<std::size_t> shuffled(std::size_t count, RandomStream& random) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i)
    std::swap(order[i - 1], order[static_cast<std::size_t>(random.uniform() * static_cast<double>(i))]);
  return order;
}

class Plan {
 public:
  Plan(const toml::table& table, const std::string& file, std::string folder)
      : table_(table), reader_(file), plan_folder_(fs::path(file).parent_path()), folder_(std::move(folder)) {}

  Sweep sweep() {
    readHead();
    rows_ = {{}};
    for (const auto& [name, section] : sections_) {
      if (name == "constants") combine(*section, {reader_.constants(*section)});
      if (name == "grid") addGrid(*section);
      if (name == "list") addList(*section);
      if (name == "latin_hypercube" || name == "random") addDrawn(*section, name);
    }
    addRepeats();
    for (auto& row : rows_) sweep_.rows.push_back({std::move(row), {}});
    return std::move(sweep_);
  }

 private:
  void readHead() {
    static const std::set<std::string> sections = {"constants", "grid", "list", "latin_hypercube", "random", "repeats"};
    const toml::node* format = table_.get("format");
    if (!format || format->value_or(std::string()) != "musclesim-sweep-1")
      reader_.refuse(format ? *format : table_, "format: must be \"musclesim-sweep-1\"");
    for (const auto& [key, node] : table_) {
      const std::string name(key.str());
      if (sections.contains(name)) {
        if (!node.is_table()) reader_.refuse(node, name + ": must be a section, [" + name + "]");
        sections_[name] = node.as_table();
      } else {
        readHeadMember(name, node);
      }
    }
    if (sweep_.command.empty()) reader_.refuse(table_, "command: is missing or empty; must be a list, for example [\"run\", \"--simple\"]");
  }

  void readHeadMember(const std::string& name, const toml::node& node) {
    if (name == "format") return;
    if (name == "command") {
      sweep_.command = reader_.texts(node, name);
    } else if (name == "columns") {
      sweep_.columns = reader_.texts(node, name);
    } else if (name == "files") {
      for (const std::string& file : reader_.texts(node, name)) files_.insert(file);
      if (!files_.empty() && folder_.empty()) reader_.refuse(node, "files: this plan is read without a folder to copy them to");
    } else if (name == "result_file") {
      sweep_.result_file = reader_.text(node, name);
    } else if (name == "row_time_limit_s") {
      sweep_.row_time_limit_s = reader_.number(node, name);
      if (sweep_.row_time_limit_s < 0) reader_.refuse(node, name + ": must be 0 or larger");
    } else if (name == "seed") {
      const auto seed = node.value_exact<std::int64_t>();
      if (!seed || *seed < 0 || *seed > largest_seed)
        reader_.refuse(node, fmt::format("seed: must be a whole number in 0 .. {}", largest_seed));
      sweep_.seed = static_cast<std::uint64_t>(*seed);
    } else {
      reader_.refuse(node,
                     fmt::format("{}: must be one of format, command, seed, files, columns, result_file, row_time_limit_s, [constants], "
                                 "[grid], [list], [latin_hypercube], [random], [repeats]",
                                 name));
    }
  }

  void requireSize(const toml::node& place, std::size_t row_count, std::size_t parameter_count) const {
    if (row_count > most_sweep_rows || row_count * parameter_count > most_sweep_values)
      reader_.refuse(place, fmt::format("the plan has {} rows of {} parameters; at most {} rows and {} values are allowed", row_count,
                                        parameter_count, most_sweep_rows, most_sweep_values));
  }

  /// Combines every row so far with every row of a section.
  void combine(const toml::node& place, const std::vector<RowParameters>& section) {
    static const std::set<std::string> reserved = {"out", "row", "repeat", "status", "message"};
    requireSize(place, rows_.size() * section.size(), rows_.front().size() + section.front().size());
    for (const auto& [name, value] : section.front())
      if (!names_.insert(name).second || reserved.contains(name)) reader_.refuse(place, name + ": is given twice or is a reserved name");
    std::vector<RowParameters> ready = section;
    for (auto& row : ready)
      for (auto& [name, value] : row)
        if (files_.contains(name)) value = copied(place, name, value);
    rows_ = combined(rows_, ready);
  }

  Parameter::Value copied(const toml::node& place, const std::string& name, const Parameter::Value& value) {
    const auto* file = std::get_if<std::string>(&value);
    if (!file) reader_.refuse(place, name + ": must be a file's name");
    const std::string path = (plan_folder_ / *file).string();
    const auto known = copies_.find(path);
    return known != copies_.end() ? known->second : copies_[path] = addInput(sweep_, folder_, path);
  }

  void addGrid(const toml::table& section) {
    std::vector<RowParameters> rows = {{}};
    for (const auto& [name, values] : reader_.lists(section)) {
      requireSize(section, rows.size() * values.size(), rows.front().size() + 1);
      std::vector<RowParameters> axis;
      for (const auto& value : values) axis.push_back({{name, value}});
      rows = combined(rows, axis);
    }
    combine(section, rows);
  }

  void addList(const toml::table& section) {
    const auto lists = reader_.lists(section);
    if (lists.empty()) return;
    std::vector<RowParameters> rows(lists.front().second.size());
    for (const auto& [name, values] : lists) {
      if (values.size() != rows.size())
        reader_.refuse(section, fmt::format("{}: has {} values, {} has {}", name, values.size(), lists.front().first, rows.size()));
      for (std::size_t i = 0; i < rows.size(); ++i) rows[i].emplace_back(name, values[i]);
    }
    combine(section, rows);
  }

  /// Latin hypercube (McKay, Beckman and Conover, 1979): each parameter's range in `count` parts of equal probability, a value from each
  /// part, in random order. Random: each value from the whole range.
  void addDrawn(const toml::table& section, const std::string& kind) {
    const toml::node* given = section.get("count");
    if (!given) reader_.refuse(section, kind + ".count: is missing");
    const std::size_t count = reader_.count(*given, kind + ".count");
    const auto distributions = reader_.distributions(section);
    requireSize(section, count, distributions.size());
    std::vector<RowParameters> rows(count);
    for (const Distribution& distribution : distributions) {
      RandomStream random(sweep_.seed, "sweep." + kind + "." + distribution.name);
      const auto parts = shuffled(count, random);
      for (std::size_t i = 0; i < count; ++i) {
        const double unit = random.uniform();
        rows[i].emplace_back(
            distribution.name,
            distribution.at(kind == "random" ? unit : (static_cast<double>(parts[i]) + unit) / static_cast<double>(count)));
      }
    }
    combine(section, rows);
  }

  bool commandUses(const std::string& name) const {
    return std::ranges::any_of(sweep_.command, [&](const auto& argument) { return argument.find("{" + name + "}") != std::string::npos; });
  }

  /// Rows of the same repeat have the same seed, so that their differences come from their parameters and not from chance. A seed that the
  /// command does not use is not listed, since the run would not have it.
  void addRepeats() {
    std::size_t count = 1;
    if (const auto found = sections_.find("repeats"); found != sections_.end()) {
      for (const auto& [key, node] : *found->second) {
        if (key != "count") reader_.refuse(node, "repeats: must have count and nothing else");
        count = reader_.count(node, "repeats.count");
      }
      requireSize(*found->second, rows_.size() * count, rows_.front().size() + 2);
      if (count > 1 && !commandUses("seed") && !commandUses("repeat"))
        reader_.refuse(*found->second, "repeats: all would be the same run; use {seed} or {repeat} in the command");
    }
    std::vector<RowParameters> rows;
    for (std::size_t i = 0; i < count; ++i) {
      rows.push_back({{"repeat", static_cast<double>(i)}});
      if (!names_.contains("seed") && commandUses("seed")) rows.back().emplace_back("seed", static_cast<double>(sweep_.seed + i));
    }
    rows_ = combined(rows_, rows);
  }

  const toml::table& table_;
  PlanReader reader_;
  fs::path plan_folder_;
  std::string folder_;
  Sweep sweep_;
  std::set<std::string> files_, names_;
  std::map<std::string, std::string> copies_;
  std::map<std::string, const toml::table*> sections_;
  std::vector<RowParameters> rows_;
};

}  // namespace

Sweep parsePlan(const std::string& text, const std::string& file, const std::string& folder) {
  const toml::table table = parseToml(text, file);
  return Plan(table, file, folder).sweep();
}

Sweep readPlan(const std::string& file, const std::string& folder) {
  const toml::table table = readToml(file);
  return Plan(table, file, folder).sweep();
}

}  // namespace musclesim
