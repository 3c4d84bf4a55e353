#include "panel.h"

#include <GL/freeglut.h>
#include <backends/imgui_impl_glut.h>
#include <backends/imgui_impl_opengl2.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "gap_plot.h"
#include "plot.h"

namespace musclesim {

namespace {

constexpr int panel_width_px = 310;
constexpr float font_px = 15, slider_row_px = 23;
const Color height_color{0.87, 0.05, 0.05, ""}, target_color{0.95, 0.50, 0.0, ""}, activity_color{0.1, 0.55, 0.1, ""},
    command_color{0.55, 0.60, 0.68, ""}, pressure_color{0.05, 0.30, 0.65, ""}, length_color{0.42, 0.20, 0.55, ""},
    force_color{0.65, 0.25, 0.10, ""};

ImVec4 shade(const Color& color, float alpha = 1) {
  return {static_cast<float>(color.red), static_cast<float>(color.green), static_cast<float>(color.blue), alpha};
}

/// Loads a system font if there is one, since the built-in font is coarse.
void chooseFont() {
  for (const char* file :
       {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
        "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf"})
    if (std::filesystem::exists(file) && ImGui::GetIO().Fonts->AddFontFromFileTTF(file, font_px)) return;
  ImGui::GetIO().Fonts->AddFontDefault();
}

void chooseLook() {
  ImGui::StyleColorsLight();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 0;
  style.FrameRounding = 3;
  style.GrabRounding = 3;
  style.WindowBorderSize = 0;
  style.FrameBorderSize = 1;
  style.WindowPadding = {12, 10};
  style.ItemSpacing = {7, 5};
  style.Colors[ImGuiCol_WindowBg] = {0.955F, 0.958F, 0.964F, 1};
  style.Colors[ImGuiCol_FrameBg] = {1, 1, 1, 1};
  style.Colors[ImGuiCol_Border] = {0.75F, 0.77F, 0.80F, 1};
  style.Colors[ImGuiCol_BorderShadow] = {0, 0, 0, 0};
}

/// Draws the overlay with the panel's font.
class ImGuiPainter final : public Painter {
 public:
  void rectangle(float x, float y, float width, float height, const Color& color, float alpha) override {
    list_->AddRectFilled({x, y}, {x + width, y + height}, ImGui::ColorConvertFloat4ToU32(shade(color, alpha)), 5);
  }
  void text(float x, float y, const std::string& text, const Color& color) override {
    list_->AddText({x, y}, ImGui::ColorConvertFloat4ToU32(shade(color)), text.c_str());
  }
  float widthOf(const std::string& text) const override { return ImGui::CalcTextSize(text.c_str()).x; }
  float lineHeight() const override { return ImGui::GetFontSize() + 4; }

 private:
  ImDrawList* list_ = ImGui::GetBackgroundDrawList();
};

class ImGuiPanel final : public Panel {
 public:
  ImGuiPanel() {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    chooseFont();
    chooseLook();
    ImGui_ImplGLUT_Init();
    ImGui_ImplOpenGL2_Init();
  }
  ~ImGuiPanel() override {
    ImGui_ImplOpenGL2_Shutdown();
    ImGui_ImplGLUT_Shutdown();
    ImGui::DestroyContext();
  }

  int widthPx() const override { return panel_width_px; }
  void resize(int width, int height) override { ImGui_ImplGLUT_ReshapeFunc(width, height); }

  /// The panel uses keys only while a number is being typed: after dragging a slider, keys must reach the scene.
  bool key(unsigned char character) override {
    if (!ImGui::GetIO().WantTextInput) return false;
    ImGui_ImplGLUT_KeyboardFunc(character, 0, 0);
    return true;
  }
  void keyUp(unsigned char character) override { ImGui_ImplGLUT_KeyboardUpFunc(character, 0, 0); }

  /// A press and its release can both arrive before the next picture. The release is then delayed by one picture, so that the press has an
  /// effect.
  bool button(int glut_button, int glut_state, int x, int y) override {
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = {static_cast<float>(x), static_cast<float>(y)};
    const int which = glut_button == GLUT_LEFT_BUTTON ? 0 : glut_button == GLUT_RIGHT_BUTTON ? 1 : 2;
    if (glut_button > GLUT_RIGHT_BUTTON) return isOver(x);
    if (glut_state == GLUT_DOWN) {
      io.MouseDown[which] = is_fresh_[which] = true;
      is_released_[which] = false;
    } else if (is_fresh_[which]) {
      is_released_[which] = true;
    } else {
      io.MouseDown[which] = false;
    }
    return glut_state == GLUT_DOWN && isOver(x);
  }
  bool move(int x, int y) override {
    ImGui_ImplGLUT_MotionFunc(x, y);
    return false;
  }

  void draw(Console& console, const Snapshot& snapshot, const History& history, int width, int height) override {
    ImGui_ImplOpenGL2_NewFrame();
    ImGui_ImplGLUT_NewFrame();
    const bool shown = console.show_panel;
    left_px_ = shown ? width - panel_width_px : width;
    ImGuiPainter painter;
    drawOverlay(painter, console, snapshot, static_cast<float>(left_px_), static_cast<float>(height), !shown);
    if (shown) drawPanel(console, snapshot, history, static_cast<float>(height));
    ImGui::Render();
    glViewport(0, 0, width, height);
    ImGui_ImplOpenGL2_RenderDrawData(ImGui::GetDrawData());
    releaseButtons();
  }

 private:
  bool isOver(int x) const { return x >= left_px_; }

  void releaseButtons() {
    for (int which = 0; which < 3; ++which) {
      is_fresh_[which] = false;
      if (is_released_[which]) ImGui::GetIO().MouseDown[which] = is_released_[which] = false;
    }
  }

  void drawPanel(Console& console, const Snapshot& snapshot, const History& history, float height) const {
    ImGui::SetNextWindowPos({static_cast<float>(left_px_), 0});
    ImGui::SetNextWindowSize({panel_width_px, height});
    ImGui::Begin("panel", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav);
    if (console.player()) {
      drawReplay(console, snapshot);
    } else {
      drawRun(console, snapshot);
      ImGui::Separator();
      drawPressures(console, snapshot);
      ImGui::Separator();
      drawPlots(console, snapshot, history);
    }
    ImGui::Separator();
    drawSwitches(console);
    ImGui::End();
  }

  static void drawRun(Console& console, const Snapshot& snapshot) {
    ImGui::Text("%.2f s", snapshot.state.time_s);
    ImGui::SameLine(110);
    bool by_hand = console.hands().isManual();
    if (ImGui::RadioButton("automatic", !by_hand) && by_hand) console.toggleManual();
    ImGui::SameLine();
    if (ImGui::RadioButton("by hand", by_hand) && !by_hand) console.toggleManual();
    drawPause(console);
    if (ImGui::Button("Step")) console.press(key::right);
    ImGui::SameLine();
    drawSpeed(console);
    ImGui::TextUnformatted(paceLine(console).c_str());
    drawRunChoice(console);
    drawStates(console);
  }

  /// A list of names; returns the one that the user chooses.
  static std::optional<std::string> chosenOf(const char* id, float width_px, const std::string& shown,
                                             const std::vector<std::string>& names) {
    ImGui::SetNextItemWidth(width_px);
    std::optional<std::string> chosen;
    if (!ImGui::BeginCombo(id, shown.c_str())) return chosen;
    for (const std::string& name : names)
      if (ImGui::Selectable(name.c_str(), name == shown)) chosen = name;
    ImGui::EndCombo();
    return chosen;
  }

  static void drawRunChoice(Console& console) {
    const float half_px = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    if (const auto robot = chosenOf("##robot", half_px, console.run().robot, console.robots)) console.chooseRobot(*robot);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("robot: another one begins a new run");
    ImGui::SameLine();
    if (const auto controller = chosenOf("##controller", half_px, console.run().controller, console.controllers))
      console.chooseController(*controller);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("controller: another one begins a new run");
  }

  static void drawStates(Console& console) {
    for (const auto& [name, code, meaning] : {std::tuple{"Reset", key::home, "begin the run anew (Home)"},
                                              {"Keep", static_cast<int>('k'), "keep this state (k)"},
                                              {"Back", static_cast<int>('b'), "back to the state kept last (b)"}}) {
      if (ImGui::Button(name, {60, 0})) console.press(code);
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", meaning);
      ImGui::SameLine();
    }
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##states", fmt::format("{} kept", console.saved().size()).c_str())) return;
    for (std::size_t i = 0; i < console.saved().size(); ++i) {
      const RunRequest& state = console.saved()[i];
      if (ImGui::Selectable(fmt::format("{}: {} at {:.2f} s", i + 1, state.robot, state.repeated.time_s).c_str())) console.restore(i);
    }
    ImGui::EndCombo();
  }

  static void drawPause(Console& console) {
    if (ImGui::Button(console.pace().isPaused() ? "Resume" : "Pause", {76, 0})) console.press('p');
    ImGui::SameLine();
  }

  static void drawSpeed(Console& console) {
    ImGui::SetNextItemWidth(-1);
    auto speed = static_cast<float>(console.pace().speed());
    if (ImGui::SliderFloat("##speed", &speed, 0.01F, 100, "speed %.3g", ImGuiSliderFlags_Logarithmic)) console.pace().setSpeed(speed);
  }

  static void drawReplay(Console& console, const Snapshot& snapshot) {
    const Player& player = *console.player();
    ImGui::Text("%.2f of %.2f s", player.timeS(), player.endS());
    drawPause(console);
    for (const auto& [name, code] : {std::pair{"<", key::left}, std::pair{">", key::right}}) {
      if (ImGui::Button(name)) console.press(code);
      ImGui::SameLine();
    }
    drawSpeed(console);
    // Each switch does what its key does.
    for (auto [name, code, is_on] :
         {std::tuple{"effects (e)", 'e', player.withEffects()}, std::tuple{"ghost (g)", 'g', player.hasGhost() && console.style.ghost},
          std::tuple{"loop (l)", 'l', player.isLooping()}}) {
      if (ImGui::Checkbox(name, &is_on)) console.press(code);
      if (code != 'l') ImGui::SameLine();
    }
    for (const std::string& line : replayLines(console, snapshot)) ImGui::TextWrapped("%s", line.c_str());
    ImGui::Separator();
    drawSignalChoice(*console.player());
    constexpr float switches_px = 34, titles_px = 60, smallest_px = 40;
    drawGapPlots(player, std::max(smallest_px, (ImGui::GetContentRegionAvail().y - switches_px - titles_px) / 2));
  }

  static void drawSignalChoice(Player& player) {
    if (!player.gap()) return;
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##signal", player.gap()->name.c_str())) return;
    for (int i = 0; i < static_cast<int>(player.gaps().size()); ++i)
      if (ImGui::Selectable(player.gaps()[static_cast<std::size_t>(i)].name.c_str(), i == player.chosen())) player.choose(i);
    ImGui::EndCombo();
  }

  /// One slider per muscle with a patch of its colour; a click on the patch selects the muscle. Many muscles scroll.
  static void drawPressures(Console& console, const Snapshot& snapshot) {
    constexpr int most_rows = 10;
    const auto rows = static_cast<float>(std::min(console.muscleCount(), most_rows));
    ImGui::BeginChild("pressures", {0, rows * slider_row_px + 2}, false, ImGuiWindowFlags_NoNav);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {7, 3});
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {4, 2});
    const musclesim::Action pressures = console.hands().pressures();
    for (int i = 0; i < console.muscleCount(); ++i) drawPressure(console, i, pressures[static_cast<std::size_t>(i)], snapshot);
    ImGui::PopStyleVar(2);
    ImGui::EndChild();
  }

  static void drawPressure(Console& console, int muscle, double pressure, const Snapshot& snapshot) {
    ImGui::PushID(muscle);
    const Color& color = snapshot.hoses.at(static_cast<std::size_t>(muscle)).color;
    const bool selected = muscle == console.selected();
    if (ImGui::ColorButton("##color", shade(color), ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop, {20, 18}))
      console.select(muscle);
    ImGui::SameLine();
    ImGui::PushStyleColor(ImGuiCol_Text, selected ? ImVec4(0.75F, 0.05F, 0.05F, 1) : ImGui::GetStyleColorVec4(ImGuiCol_Text));
    ImGui::Text("%2d", muscle);
    ImGui::PopStyleColor();
    ImGui::SameLine(52);
    ImGui::SetNextItemWidth(-1);
    ImGui::PushStyleColor(ImGuiCol_SliderGrab, shade(color));
    ImGui::PushStyleColor(ImGuiCol_SliderGrabActive, shade(color));
    ImGui::PushStyleColor(ImGuiCol_FrameBg, selected ? ImVec4(1, 0.90F, 0.88F, 1) : ImVec4(1, 1, 1, 1));
    auto value = static_cast<float>(pressure);
    if (ImGui::SliderFloat("##pressure", &value, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp)) {
      console.select(muscle);
      console.setPressure(muscle, static_cast<double>(value));
    }
    ImGui::PopStyleColor(3);
    ImGui::PopID();
  }

  /// A plot that the user may choose.
  struct LivePlot {
    std::string name, title;
    std::vector<PlotCurve> curves;
    std::optional<std::pair<double, double>> range;
  };

  static std::vector<LivePlot> plotsOf(const Console& console, const Snapshot& snapshot) {
    std::vector<LivePlot> plots;
    if (snapshot.state.hand_mm) plots.push_back({"height", "", heightCurves(snapshot), {}});
    if (snapshot.activity)
      plots.push_back({"activity", "", {{"activity", activity_color, [](const History::Sample& s) { return s.activity; }}}, {}});
    if (!snapshot.angle_names.empty()) plots.push_back({"angles", "angles/deg", angleCurves(snapshot), {}});
    const auto muscle = static_cast<std::size_t>(std::max(0, console.selected()));
    plots.push_back(
        {"pressure",
         fmt::format("muscle {}", muscle),
         {{"command", command_color, entryOf(&State::command, muscle)}, {"pressure", pressure_color, entryOf(&State::pressure, muscle)}},
         std::pair(0.0, 1.0)});
    plots.push_back({"length", "", {{"length/mm", length_color, entryOf(&State::length_mm, muscle)}}, {}});
    plots.push_back({"force", "", {{"force/N", force_color, entryOf(&State::force_N, muscle)}}, {}});
    for (const int axis : {0, 2})
      if (snapshot.state.hand_mm) {
        const std::string name = axis == 0 ? "hand x" : "hand z";
        plots.push_back({name, "", {{name + "/mm", height_color, handCurve(axis)}}, {}});
      }
    return plots;
  }

  using Value = std::function<std::optional<double>(const History::Sample&)>;

  static Value entryOf(std::vector<double> State::*signal, std::size_t entry) {
    return [entry, signal](const History::Sample& sample) -> std::optional<double> {
      const auto& values = sample.state.*signal;
      return entry < values.size() ? std::optional(values[entry]) : std::nullopt;
    };
  }

  static Value handCurve(int axis) {
    return [axis](const History::Sample& sample) -> std::optional<double> {
      return sample.state.hand_mm ? std::optional((*sample.state.hand_mm)[axis]) : std::nullopt;
    };
  }

  static std::vector<PlotCurve> heightCurves(const Snapshot& snapshot) {
    std::vector<PlotCurve> curves;
    if (snapshot.target) curves.push_back({"target", target_color, [](const History::Sample& s) { return s.target_height_mm; }});
    curves.push_back({"height/mm", height_color, handCurve(1)});
    return curves;
  }

  static std::vector<PlotCurve> angleCurves(const Snapshot& snapshot) {
    const Color colors[] = {pressure_color, force_color, activity_color, length_color};
    std::vector<PlotCurve> curves;
    for (std::size_t i = 0; i < snapshot.angle_names.size(); ++i)
      curves.push_back({snapshot.angle_names[i], colors[i % std::size(colors)], entryOf(&State::angle_deg, i)});
    return curves;
  }

  static void choosePlots(Console& console, const std::vector<LivePlot>& plots) {
    ImGui::SetNextItemWidth(90);
    if (!ImGui::BeginCombo("##plots", "plots")) return;
    for (const LivePlot& plot : plots) {
      const bool is_shown = !console.hidden_plots.contains(plot.name);
      if (!ImGui::Selectable(plot.name.c_str(), is_shown, ImGuiSelectableFlags_DontClosePopups)) continue;
      if (is_shown)
        console.hidden_plots.insert(plot.name);
      else
        console.hidden_plots.erase(plot.name);
    }
    ImGui::EndCombo();
  }

  static void drawPlots(Console& console, const Snapshot& snapshot, const History& history) {
    constexpr float switches_px = 34, title_px = 21, smallest_px = 18;
    std::vector<LivePlot> plots = plotsOf(console, snapshot);
    drawReach();
    choosePlots(console, plots);
    std::erase_if(plots, [&](const LivePlot& plot) { return console.hidden_plots.contains(plot.name); });
    const auto count = static_cast<float>(std::max<std::size_t>(1, plots.size()));
    const float height = std::max(smallest_px, (ImGui::GetContentRegionAvail().y - switches_px) / count - title_px - 5);
    for (const LivePlot& plot : plots) drawPlot(plot.title, plot.curves, history, height, plot.range);
  }

  /// Writes the duration of the plots at the right end of the line.
  static void drawReach() {
    const std::string reach = fmt::format("last {:g} s", History::duration_s);
    const ImVec2 line = ImGui::GetCursorScreenPos();
    const float right = line.x + ImGui::GetContentRegionAvail().x;
    ImGui::GetWindowDrawList()->AddText({right - ImGui::CalcTextSize(reach.c_str()).x, line.y}, IM_COL32(130, 135, 142, 255),
                                        reach.c_str());
  }

  static void drawSwitches(Console& console) {
    bool is_first = true;
    for (const auto& [name, is_on, meaning] : {std::tuple{"clear", &console.style.transparent, "transparent bones (t)"},
                                               {"tension", &console.style.color_tension, "colour muscles by tension (m)"},
                                               {"labels", &console.style.frames, "frames and labels (f)"},
                                               {"arrows", &console.style.arrows, "tensions and contacts as arrows (a)"}}) {
      if (!std::exchange(is_first, false)) ImGui::SameLine();
      ImGui::Checkbox(name, is_on);
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", meaning);
    }
  }

  int left_px_ = 1 << 30;
  std::array<bool, 3> is_fresh_ = {}, is_released_ = {};
};

}  // namespace

std::unique_ptr<Panel> Panel::make() {
  return std::make_unique<ImGuiPanel>();
}

}  // namespace musclesim
