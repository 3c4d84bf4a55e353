#include "law_families.h"

#include <fmt/format.h>

#include <cmath>

#include "map_model.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/chou_hannaford.h"
#include "musclesim/robot/sarosi.h"

namespace musclesim {

namespace {

constexpr double unbounded = 1e12;

/// Eq. 1. The fit adjusts c, b, K = newton_per_kgf c a exp(b) (the force at full length without pressure), and the free lengths. It uses K
/// instead of a, because a changes by powers of ten for small changes of b.
class BraunModel final : public LawModel {
 public:
  BraunModel(const Specimen& specimen, const BraunLengths& lengths) : specimen_(specimen), lengths_(lengths) {
    parameters_ = {{"c_kgf", -unbounded, unbounded}, {"b", -50, 50}, {"K_N", -unbounded, unbounded}};
    if (!lengths_.minimum_mm) parameters_.push_back({"l_min_mm", 0.01 * specimen_.shortest_mm, 0.98 * specimen_.rest_length_mm});
    if (!lengths_.maximum_mm) parameters_.push_back({"l_max_mm", 0.99 * specimen_.rest_length_mm, 10 * specimen_.rest_length_mm});
  }
  std::string name() const override { return "braun"; }
  const std::vector<FitParameter>& parameters() const override { return parameters_; }

  std::vector<Eigen::VectorXd> starts() const override {
    std::vector<Eigen::VectorXd> result;
    for (const double b : {-5.0, 1.0, 8.0})
      for (const double vented_share : {-0.1, 0.3})
        for (const double shortest_share : {0.4, 0.9}) {
          std::vector<double> start = {specimen_.force_scale_N / newton_per_kgf, b, vented_share * specimen_.force_scale_N};
          if (!lengths_.minimum_mm) start.push_back(shortest_share * specimen_.shortest_mm);
          if (!lengths_.maximum_mm) start.push_back(1.05 * specimen_.rest_length_mm);
          result.push_back(Eigen::Map<Eigen::VectorXd>(start.data(), static_cast<Eigen::Index>(start.size())));
          if (lengths_.minimum_mm) break;
        }
    return result;
  }

  std::unique_ptr<ForceLaw> build(const Eigen::VectorXd& x) const override {
    const All all = allOf(x);
    return std::make_unique<BraunForceLaw>(all.minimum_mm, all.maximum_mm, all.constants);
  }

  std::vector<LawConstant> constants() const override {
    std::vector<LawConstant> result = {{"a", "", true}, {"b", ""}, {"c", "kgf"}};
    if (!lengths_.minimum_mm) result.push_back({"l_min", "mm"});
    if (!lengths_.maximum_mm) result.push_back({"l_max", "mm"});
    return result;
  }

  Eigen::VectorXd constantsAt(const Eigen::VectorXd& x) const override {
    const All all = allOf(x);
    Eigen::VectorXd result(x.size());
    result.head(3) << all.constants.a, all.constants.b, all.constants.c_kgf;
    result.tail(x.size() - 3) = x.tail(x.size() - 3);
    return result;
  }

  std::vector<std::pair<std::string, std::string>> configuration(const Eigen::VectorXd& x) const override {
    const All all = allOf(x);
    return {{"minimum_length_ratio", fmt::format("{}", all.minimum_mm / all.maximum_mm)},
            {"a", fmt::format("{}", all.constants.a)},
            {"b", fmt::format("{}", all.constants.b)},
            {"c_kgf", fmt::format("{}", all.constants.c_kgf)}};
  }

  double restLengthMm(const Eigen::VectorXd& x) const override { return allOf(x).maximum_mm; }

 private:
  struct All {
    BraunConstants constants;
    double minimum_mm, maximum_mm;
  };

  All allOf(const Eigen::VectorXd& x) const {
    All all;
    Eigen::Index next = 3;
    all.minimum_mm = lengths_.minimum_mm ? *lengths_.minimum_mm : x(next++);
    all.maximum_mm = lengths_.maximum_mm ? *lengths_.maximum_mm : x(next);
    all.constants.c_kgf = x(0);
    all.constants.b = x(1);
    all.constants.a = x(2) / (newton_per_kgf * x(0)) * std::exp(-x(1));
    return all;
  }

  Specimen specimen_;
  BraunLengths lengths_;
  std::vector<FitParameter> parameters_;
};

/// A family whose parameters are its constants.
class PlainModel : public LawModel {
 public:
  PlainModel(const Specimen& specimen, std::vector<FitParameter> parameters, std::vector<LawConstant> constants)
      : specimen_(specimen), parameters_(std::move(parameters)), constants_(std::move(constants)) {}
  const std::vector<FitParameter>& parameters() const override { return parameters_; }
  std::vector<LawConstant> constants() const override { return constants_; }
  double restLengthMm(const Eigen::VectorXd&) const override { return specimen_.rest_length_mm; }
  std::vector<std::pair<std::string, std::string>> configuration(const Eigen::VectorXd& x) const override {
    std::vector<std::pair<std::string, std::string>> result;
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      result.emplace_back(parameters_[i].name, fmt::format("{}", x(static_cast<Eigen::Index>(i))));
    return result;
  }

 protected:
  Specimen specimen_;

 private:
  std::vector<FitParameter> parameters_;
  std::vector<LawConstant> constants_;
};

/// Initial exponents of an exponential: it decays within 1/10 to 1/80 of the rest length.
constexpr double exponent_starts[] = {10, 30, 80};
constexpr double largest_exponent = 300;
/// Weight of the penalty on an exponential's force. Without points near the rest length the points do not determine this force; the penalty
/// keeps it bounded. If the points determine it, the penalty changes it by at most 1e-4 of itself.
constexpr double stretch_penalty = 3e-3;

/// F = p (A s^2 - B) - D + E exp(beta (s - 1)).
class ChouHannafordModel final : public PlainModel {
 public:
  explicit ChouHannafordModel(const Specimen& specimen)
      : PlainModel(specimen,
                   {{"braid_N", -unbounded, unbounded},
                    {"bore_N", -unbounded, unbounded},
                    {"threshold_N", -unbounded, unbounded},
                    {"stretch_N", -unbounded, unbounded},
                    {"stretch_exponent", 1, largest_exponent}},
                   {{"A", "N"}, {"B", "N"}, {"D", "N"}, {"E", "N"}, {"beta", ""}}) {}
  std::string name() const override { return "chou-hannaford"; }
  std::vector<Eigen::VectorXd> starts() const override {
    std::vector<Eigen::VectorXd> result;
    const double scale_N = specimen_.force_scale_N;
    for (const double exponent : exponent_starts)
      result.push_back((Eigen::VectorXd(5) << 2 * scale_N, scale_N, 0.2 * scale_N, 0.1 * scale_N, exponent).finished());
    return result;
  }
  Eigen::VectorXd penaltiesN(const Eigen::VectorXd& x) const override { return stretch_penalty * x.segment(3, 1); }
  std::unique_ptr<ForceLaw> build(const Eigen::VectorXd& x) const override {
    ChouHannafordConstants constants;
    constants.braid_N = x(0);
    constants.bore_N = x(1);
    constants.elastic_N = 0;
    constants.threshold_N = x(2);
    constants.stretch_N = x(3);
    constants.stretch_exponent = x(4);
    return std::make_unique<ChouHannafordForceLaw>(specimen_.rest_length_mm, constants);
  }
};

/// F = p (A s^2 - B) + C (s - 1) - D: linear in its constants.
class ChouHannafordLinearModel final : public PlainModel {
 public:
  explicit ChouHannafordLinearModel(const Specimen& specimen)
      : PlainModel(specimen,
                   {{"braid_N", -unbounded, unbounded},
                    {"bore_N", -unbounded, unbounded},
                    {"elastic_N", -unbounded, unbounded},
                    {"threshold_N", -unbounded, unbounded}},
                   {{"A", "N"}, {"B", "N"}, {"C", "N"}, {"D", "N"}}) {}
  std::string name() const override { return "chou-hannaford-linear"; }
  std::vector<Eigen::VectorXd> starts() const override {
    const double scale_N = specimen_.force_scale_N;
    return {(Eigen::VectorXd(4) << 2 * scale_N, scale_N, 0, 0.2 * scale_N).finished()};
  }
  std::unique_ptr<ForceLaw> build(const Eigen::VectorXd& x) const override {
    ChouHannafordConstants constants;
    constants.braid_N = x(0);
    constants.bore_N = x(1);
    constants.elastic_N = x(2);
    constants.threshold_N = x(3);
    constants.stretch_N = 0;
    return std::make_unique<ChouHannafordForceLaw>(specimen_.rest_length_mm, constants);
  }
  std::vector<std::pair<std::string, std::string>> configuration(const Eigen::VectorXd& x) const override {
    auto result = PlainModel::configuration(x);
    result.emplace_back("stretch_N", "0");
    return result;
  }
};

/// F = (a1 p + a2) exp(a3 k) + a4 k p + a5 p + a6.
class SarosiModel final : public PlainModel {
 public:
  explicit SarosiModel(const Specimen& specimen)
      : PlainModel(specimen,
                   {{"a1_N", -unbounded, unbounded},
                    {"a2_N", -unbounded, unbounded},
                    {"a3", -largest_exponent, -1},
                    {"a4_N", -unbounded, unbounded},
                    {"a5_N", -unbounded, unbounded},
                    {"a6_N", -unbounded, unbounded}},
                   {{"a1", "N"}, {"a2", "N"}, {"a3", ""}, {"a4", "N"}, {"a5", "N"}, {"a6", "N"}}) {}
  std::string name() const override { return "sarosi"; }
  std::vector<Eigen::VectorXd> starts() const override {
    std::vector<Eigen::VectorXd> result;
    const double scale_N = specimen_.force_scale_N;
    for (const double exponent : exponent_starts)
      result.push_back((Eigen::VectorXd(6) << 0.05 * scale_N, 0.1 * scale_N, -exponent, -3 * scale_N, scale_N, -0.2 * scale_N).finished());
    return result;
  }
  Eigen::VectorXd penaltiesN(const Eigen::VectorXd& x) const override { return stretch_penalty * x.head(2); }
  std::unique_ptr<ForceLaw> build(const Eigen::VectorXd& x) const override {
    SarosiConstants constants;
    constants.a1_N = x(0);
    constants.a2_N = x(1);
    constants.a3 = x(2);
    constants.a4_N = x(3);
    constants.a5_N = x(4);
    constants.a6_N = x(5);
    return std::make_unique<SarosiForceLaw>(specimen_.rest_length_mm, constants);
  }
};

}  // namespace

const std::vector<std::string>& lawModelNames() {
  static const std::vector<std::string> names = {"braun", "chou-hannaford-linear", "chou-hannaford", "sarosi", "map"};
  return names;
}

std::unique_ptr<LawModel> makeLawModel(const std::string& name, const Specimen& specimen, const BraunLengths& lengths) {
  if (name == "braun") return std::make_unique<BraunModel>(specimen, lengths);
  if (name == "chou-hannaford-linear") return std::make_unique<ChouHannafordLinearModel>(specimen);
  if (name == "chou-hannaford") return std::make_unique<ChouHannafordModel>(specimen);
  if (name == "sarosi") return std::make_unique<SarosiModel>(specimen);
  if (name == "map") return std::make_unique<MapModel>(specimen);
  const std::string nearest = nearestName(name, lawModelNames());
  throw BadParameter(
      "law", name,
      fmt::format("be all or one of {}{}", fmt::join(lawModelNames(), ", "), nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
}

}  // namespace musclesim
