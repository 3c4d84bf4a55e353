/// The finished cases of an interrupted call of `musclesim blind make`, whose key is not sealed yet.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace musclesim::blind {

/// The keys of single cases, in a folder of their own below the folder of keys, each written when the recordings of its case are complete.
class UnsealedCases {
 public:
  /// For the call that `call` describes: its folder and all that its cases depend on. Throws BadParameter if the folder belongs to another
  /// call.
  UnsealedCases(const std::filesystem::path& key_folder, nlohmann::json call);
  /// Whether an earlier call like this one has begun.
  bool exist() const;
  void begin() const;
  std::optional<nlohmann::json> keyOf(const std::string& case_name) const;
  void keep(const std::string& case_name, const nlohmann::json& key) const;
  /// To be called when the key of all has been sealed.
  void remove() const;

 private:
  std::filesystem::path fileOf(const std::string& case_name) const;
  std::filesystem::path folder_;
  nlohmann::json call_;
};

}  // namespace musclesim::blind
