/// A cache of predictions, so that no simulation runs twice.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace musclesim {

/// Prediction of a model for one recording: values[signal][row], NaN after a divergence.
struct Prediction {
  std::vector<std::vector<double>> values;
  bool diverged = false;
  bool refused = false;  ///< not simulated, because such an effect cannot act on this plant
};

/// Predictions by key. Thread-safe; if two threads ask for the same key at the same time, both may make it.
class PredictionStore {
 public:
  /// Clears itself when it would hold more numbers than the limit.
  explicit PredictionStore(std::size_t number_limit = 8'000'000) : number_limit_(number_limit) {}

  /// The prediction of this key; calls `make` if it is not stored.
  Prediction get(const std::string& key, const std::function<Prediction()>& make);
  /// Whether the key is asked for for the first time, forgotten ones included. Marks it as asked for.
  bool isNew(const std::string& key);

 private:
  const std::size_t number_limit_;
  std::mutex access_;
  std::size_t number_count_ = 0;
  std::map<std::string, std::shared_ptr<const Prediction>> predictions_;
  std::set<std::string> asked_;
};

}  // namespace musclesim
