/// Predictions that were made before are not simulated again.
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

/// What a model predicts for one recording: values[signal][row], NaN after a divergence.
struct Prediction {
  std::vector<std::vector<double>> values;
  bool diverged = false;
  bool refused = false;  ///< not simulated: such an effect cannot act on this plant
};

/// Predictions by what they were made of. May be used from several threads; what two ask for at the same time may be made twice.
class PredictionStore {
 public:
  /// It forgets everything when it would hold more numbers than that.
  explicit PredictionStore(std::size_t number_limit = 8'000'000) : number_limit_(number_limit) {}

  /// The prediction of this key, by `make` if it is not there.
  Prediction get(const std::string& key, const std::function<Prediction()>& make);
  /// Whether the key has never been asked for before, forgotten ones included. It counts as asked for from now on.
  bool isNew(const std::string& key);

 private:
  const std::size_t number_limit_;
  std::mutex access_;
  std::size_t number_count_ = 0;
  std::map<std::string, std::shared_ptr<const Prediction>> predictions_;
  std::set<std::string> asked_;
};

}  // namespace musclesim
