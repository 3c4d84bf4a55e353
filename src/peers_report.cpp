#include "peers_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "bench_report.h"
#include "musclesim/version.h"

namespace musclesim::command_line {

namespace {

constexpr const char* first_line = "<!-- peers: written by musclesim bench --peers -->";
constexpr const char* last_line = "<!-- end of peers -->";
constexpr const char* own_name = "musclesim";

std::string robotName(bool chains) {
  return chains ? "chains" : "line muscles";
}

std::string row(const PeerResult& r) {
  const std::string name = r.version.empty() ? r.engine : r.engine + " " + r.version;
  const std::string n = fmt::format("{}{}", r.muscle_count, r.rule == PeerRule::early ? "*" : "");
  if (!r.failure.empty()) return fmt::format("| {} | {} | {} | | | | | | | |\n", n, name, r.failure);
  return fmt::format("| {} | {} | {} | {:.3g} | {:.1f}, {:.1f} | {:.2g} | {:.1f}, {:.1f} | {:.3g} | {:.2f} | {:.2f} ({:.2f} .. {:.2f}) |\n",
                     n, name, r.method, r.step_ms, r.early_mm, r.late_mm, r.gap_mm, r.early_from_ours_mm, r.late_from_ours_mm, r.ratio,
                     r.step_over_ours, r.over_ours, r.least, r.largest);
}

std::string table(const std::vector<PeerResult>& results, bool chains) {
  std::string text = fmt::format(
      "### {}\n\n| n | engine | method | step ms | hand beside its own converged path, mm | joint gap mm | converged path beside ours, mm "
      "| r | a step over ours | CPU "
      "time over ours: median (least .. largest) |\n|---|---|---|---|---|---|---|---|---|---|\n",
      chains ? "Chains" : "Line muscles");
  for (const PeerResult& r : results)
    if (r.chains == chains) text += row(r);
  return text + "\n";
}

/// Says where another engine is faster, and by how much ours is faster elsewhere.
std::string verdict(const std::vector<PeerResult>& results) {
  std::string wins, losses;
  for (const PeerResult& r : results) {
    if (r.engine == own_name || !r.failure.empty()) continue;
    const std::string where = fmt::format("{}, n = {}, {}", r.engine, r.muscle_count, robotName(r.chains));
    if (r.over_ours < 1)
      losses += fmt::format("{}{} ({:.2f} of our time)", losses.empty() ? "" : "; ", where, r.over_ours);
    else
      wins += fmt::format("{}{} ({:.1f} times ours)", wins.empty() ? "" : "; ", where, r.over_ours);
  }
  return "Another engine is faster: " + (losses.empty() ? std::string("nowhere in this table") : losses) +
         ".\n\nmusclesim is faster: " + (wins.empty() ? std::string("nowhere in this table") : wins) + ".\n";
}

std::vector<BenchCurve> curvesOf(const std::vector<PeerResult>& results) {
  std::vector<BenchCurve> curves;
  for (const PeerResult& r : results) {
    if (!r.failure.empty()) continue;
    const std::string name = r.engine + ", " + robotName(r.chains);
    auto curve = std::ranges::find(curves, name, &BenchCurve::name);
    if (curve == curves.end()) curve = curves.insert(curves.end(), {name, {}});
    BenchRun run;
    run.muscle_count = r.muscle_count;
    run.ratio = r.ratio;
    curve->runs.push_back(run);
  }
  return curves;
}

}  // namespace

std::string peersSection(const std::vector<PeerResult>& results, int repeat_count, double time_limit_s) {
  std::string text = fmt::format(
      "{}\n\n## Other engines\n\nThe RoboticArm in `si` without contacts, in musclesim " MUSCLESIM_VERSION
      " and in other engines: bodies, joints, stops, friction and muscles are read from the robot, its muscle law is musclesim's in all of "
      "them. {} sequences of random pressures, new ones every 0.25 s, each from the pose as built, the same for all. Each engine has its "
      "cheapest method and its longest step that keep the rule in the median of the sequences, together with the next shorter step tried: "
      "the "
      "hand within {:g} mm of the engine's own converged path (steps of 0.025 ms) after {:g} s and after {:g} s, no joint open by more "
      "than "
      "{:g} mm. *: with no step musclesim keeps the rule after {:g} s, because small differences grow; there the rule after {:g} s counts, "
      "for "
      "all engines.\n\nr: CPU time of one thread over simulated time, of these {:g} s. A step over ours: CPU time of one step over that of "
      "one "
      "of musclesim's. All engines took turns in one process; ratios are of the same turn, {} turns. An engine whose run used more than "
      "{:g} s "
      "of CPU time was given up.\n\n",
      first_line, peer_sequence_count, peer_rule_hand_mm, peer_rule_early_s, peer_rule_late_s, peer_rule_gap_mm, peer_rule_late_s,
      peer_rule_early_s, peer_rule_late_s, repeat_count, time_limit_s);
  text += table(results, true) + table(results, false) + verdict(results);
  text +=
      "\nWhat is not the same. Two balls between the same two bones are one hinge in the other engines. Joints of MuJoCo and Simbody need "
      "no constraint and cannot open except where a chain closes a loop; all joints of Bullet are constraints, as musclesim's are. Hinges "
      "between links do not bounce off their stops there. At a stop musclesim's "
      "friction presses into it, as ODE's does.\n\nMuJoCo: stops and friction are springs and dampers with its default impedance. \"Added "
      "inertia\": beads gain what musclesim's gain, in proportion to the square of the step, which allows longer steps.\n\nSimbody: a "
      "joint "
      "has neither dry friction nor stops, only forces. Friction is F tanh(v/v0), v0 = 50 mm/s or 2 rad/s, and stops are springs of 1 "
      "kN/mm "
      "in sliders, 33 N m/rad between links and 5 kN m/rad between bones; they let the elbow, which begins at its stop, give way by some "
      "millimetres at the hand.\n\nBullet: double precision, its usual world of rigid bodies. Dry friction is a motor with bounded force; "
      "errors of position are corrected by a fifth in each step, its default. The number is that of its solver's sweeps; Dantzig solves "
      "exactly, at a cost that grows with the cube of the number of joints.\n";
  return text + "\n![r over the number of muscles, musclesim and other engines](figures/peers.svg)\n\n" + last_line + "\n";
}

std::string peersFigure(const std::vector<PeerResult>& results) {
  return benchFigure(curvesOf(results), BenchReference::none);
}

nlohmann::json peersJson(const std::vector<PeerResult>& results) {
  nlohmann::json json;
  json["command"] = "bench";
  json["status"] = "done";
  json["peers"] = nlohmann::json::array();
  for (const PeerResult& r : results) {
    nlohmann::json entry = {
        {"engine", r.engine}, {"version", r.version}, {"muscle_count", r.muscle_count}, {"muscles", r.chains ? "chain" : "line"}};
    if (r.failure.empty())
      entry.update({{"method", r.method},
                    {"step_ms", r.step_ms},
                    {"ratio", r.ratio},
                    {"over_ours", r.over_ours},
                    {"hand_mm", {r.early_mm, r.late_mm}},
                    {"hand_from_ours_mm", {r.early_from_ours_mm, r.late_from_ours_mm}},
                    {"gap_mm", r.gap_mm}});
    else
      entry["failure"] = r.failure;
    json["peers"].push_back(entry);
  }
  return json;
}

std::string peersSectionOf(const std::string& document) {
  const auto begin = document.find(first_line), end = document.find(last_line);
  if (begin == std::string::npos || end == std::string::npos || end < begin) return "";
  return document.substr(begin, end + std::string_view(last_line).size() + 1 - begin);
}

std::string withPeersSection(const std::string& document, const std::string& section) {
  std::string text = document;
  const std::string old = peersSectionOf(document);
  if (old.empty()) return text + (text.empty() ? "" : "\n") + section;
  return text.replace(text.find(old), old.size(), section);
}

}  // namespace musclesim::command_line
