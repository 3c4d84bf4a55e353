#include "prediction_store.h"

namespace musclesim {

Prediction PredictionStore::get(const std::string& key, const std::function<Prediction()>& make) {
  std::shared_ptr<const Prediction> known;
  {
    const std::lock_guard lock(access_);
    if (const auto found = predictions_.find(key); found != predictions_.end()) known = found->second;
  }
  if (known) return *known;
  auto made = std::make_shared<const Prediction>(make());
  std::size_t count = 0;
  for (const auto& values : made->values) count += values.size();
  const std::lock_guard lock(access_);
  if (number_count_ + count > number_limit_) {
    predictions_.clear();
    number_count_ = 0;
  }
  if (predictions_.try_emplace(key, made).second) number_count_ += count;
  return *made;
}

bool PredictionStore::isNew(const std::string& key) {
  const std::lock_guard lock(access_);
  return asked_.insert(key).second;
}

}  // namespace musclesim
