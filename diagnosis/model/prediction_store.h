/// A cache of predictions, so that no simulation runs twice.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "musclesim/base/record_file.h"

namespace musclesim {

/// Prediction of a model for one recording: values[signal][row], NaN after a divergence.
struct Prediction {
  std::vector<std::vector<double>> values;
  bool diverged = false;
  bool refused = false;  ///< not simulated, because such an effect cannot act on this plant
  bool cut = false;      ///< the user ended the diagnosis during this simulation; another diagnosis must not use it
};

/// The bytes of a prediction for a RecordFile. Numbers keep their bits; the missing ones (quiet NaN) at the end of a signal take no room.
std::string bytesOf(const Prediction& prediction);
/// The prediction in these bytes; none if they are not what bytesOf makes.
std::optional<Prediction> predictionFrom(std::string_view bytes);

/// Predictions by key. Thread-safe; if two threads ask for the same key at the same time, both may make it.
class PredictionStore {
 public:
  /// Clears itself when it would hold more numbers than the limit. `kept`: a file that has predictions of an earlier process and keeps
  /// those of this one, or null.
  explicit PredictionStore(RecordFile* kept = nullptr, std::size_t number_limit = 8'000'000) : number_limit_(number_limit), kept_(kept) {}

  /// The prediction of this key; calls `make` if neither the store nor the file has it.
  Prediction get(const std::string& key, const std::function<Prediction()>& make);
  /// Whether the key is asked for for the first time, forgotten ones included. Marks it as asked for.
  bool isNew(const std::string& key);

 private:
  Prediction keptOr(const std::string& key, const std::function<Prediction()>& make) const;

  const std::size_t number_limit_;
  RecordFile* const kept_;
  std::mutex access_;
  std::size_t number_count_ = 0;
  std::map<std::string, std::shared_ptr<const Prediction>> predictions_;
  std::set<std::string> asked_;
};

}  // namespace musclesim
