#include "follow_up_files.h"

#include "seal.h"
#include "sha256.h"

namespace musclesim::blind {

namespace fs = std::filesystem;

std::string answerFingerprint(const fs::path& folder, const std::string& name) {
  return sha256OfFiles(folder, {"answers/" + name + ".json"});
}

fs::path followUpFile(const fs::path& folder, const std::string& name) {
  return folder / "follow_up" / (name + ".json");
}

bool isFollowed(const fs::path& folder, const std::string& name) {
  const fs::path file = followUpFile(folder, name);
  return fs::exists(file) && readObject(file).value("answer_sha256", "") == answerFingerprint(folder, name);
}

}  // namespace musclesim::blind
