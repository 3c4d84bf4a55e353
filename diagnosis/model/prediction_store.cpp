#include "prediction_store.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

namespace musclesim {

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

void append(std::string& bytes, std::uint64_t number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// Number of values up to the last one that is not missing.
std::size_t heldCount(const std::vector<double>& values) {
  std::size_t count = values.size();
  while (count > 0 && std::bit_cast<std::uint64_t>(values[count - 1]) == std::bit_cast<std::uint64_t>(missing)) --count;
  return count;
}

/// Takes `size` bytes from the front; returns whether there were as many.
bool take(std::string_view& bytes, void* to, std::size_t size) {
  if (bytes.size() < size) return false;
  if (size > 0) std::memcpy(to, bytes.data(), size);
  bytes.remove_prefix(size);
  return true;
}

}  // namespace

std::string bytesOf(const Prediction& prediction) {
  std::string bytes;
  append(bytes, prediction.diverged ? 1 : 0);
  append(bytes, prediction.refused ? 1 : 0);
  append(bytes, prediction.values.size());
  for (const std::vector<double>& values : prediction.values) {
    const std::size_t held = heldCount(values);
    append(bytes, values.size());
    append(bytes, held);
    bytes.append(reinterpret_cast<const char*>(values.data()), held * sizeof(double));
  }
  return bytes;
}

std::optional<Prediction> predictionFrom(std::string_view bytes) {
  constexpr std::uint64_t most_rows = 100'000'000;  // more than a recording can have
  std::uint64_t diverged = 0, refused = 0, signal_count = 0;
  for (std::uint64_t* number : {&diverged, &refused, &signal_count})
    if (!take(bytes, number, sizeof *number)) return std::nullopt;
  Prediction prediction{{}, diverged != 0, refused != 0};
  for (std::uint64_t i = 0; i < signal_count; ++i) {
    std::uint64_t count = 0, held = 0;
    if (!take(bytes, &count, sizeof count) || !take(bytes, &held, sizeof held)) return std::nullopt;
    if (held > count || count > most_rows || held > bytes.size() / sizeof(double)) return std::nullopt;
    std::vector<double> values(count, missing);
    take(bytes, values.data(), held * sizeof(double));
    prediction.values.push_back(std::move(values));
  }
  if (!bytes.empty()) return std::nullopt;
  return prediction;
}

Prediction PredictionStore::keptOr(const std::string& key, const std::function<Prediction()>& make) const {
  if (!kept_) return make();
  if (const auto bytes = kept_->find(key))
    if (auto prediction = predictionFrom(*bytes)) return std::move(*prediction);
  Prediction made = make();
  if (!made.cut) kept_->add(key, bytesOf(made));
  return made;
}

Prediction PredictionStore::get(const std::string& key, const std::function<Prediction()>& make) {
  std::shared_ptr<const Prediction> known;
  {
    const std::lock_guard lock(access_);
    if (const auto found = predictions_.find(key); found != predictions_.end()) known = found->second;
  }
  if (known) return *known;
  auto made = std::make_shared<const Prediction>(keptOr(key, make));
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
