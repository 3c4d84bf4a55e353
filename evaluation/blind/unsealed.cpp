#include "unsealed.h"

#include <utility>

#include "musclesim/base/error.h"
#include "seal.h"

namespace musclesim::blind {

namespace fs = std::filesystem;
using nlohmann::json;

UnsealedCases::UnsealedCases(const fs::path& key_folder, json call) : folder_(key_folder / "unsealed"), call_(std::move(call)) {
  if (exist() && readObject(fileOf("call")) != call_)
    throw BadParameter("--keys", key_folder.string(),
                       "hold no unfinished cases of another program or call: finish those, or remove " + folder_.string() +
                           " and their cases; " + fileOf("call").string() + " says what they are");
}

bool UnsealedCases::exist() const {
  return fs::exists(fileOf("call"));
}

void UnsealedCases::begin() const {
  fs::create_directories(folder_);
  writeObject(call_, fileOf("call"));
}

std::optional<json> UnsealedCases::keyOf(const std::string& case_name) const {
  if (!fs::exists(fileOf(case_name))) return {};
  return readObject(fileOf(case_name));
}

void UnsealedCases::keep(const std::string& case_name, const json& key) const {
  writeObject(key, fileOf(case_name));
}

void UnsealedCases::remove() const {
  fs::remove_all(folder_);
}

fs::path UnsealedCases::fileOf(const std::string& case_name) const {
  return folder_ / (case_name + ".json");
}

}  // namespace musclesim::blind
