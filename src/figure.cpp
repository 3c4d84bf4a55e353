/// `musclesim figure`: draws signals of recordings over time.
#include "musclesim/log/figure.h"

#include <fmt/format.h>

#include <filesystem>

#include "commands.h"
#include "log/figure_file.h"
#include "musclesim/base/text.h"
#include "musclesim/log/recording.h"
#include "output_folder.h"

namespace musclesim::command_line {

namespace {

struct FigureArguments {
  std::string recording;
  std::optional<std::string> out, title;
  std::vector<std::string> signals, ignore_columns;
};

int figure(const ModelOptions& model, const FigureArguments& arguments) {
  const Recording recording = readRecording(arguments.recording, {arguments.ignore_columns});
  for (const auto& note : recording.notes) say(model, note);
  const std::filesystem::path out = arguments.out.value_or(std::filesystem::path(arguments.recording).replace_extension(".svg").string());
  requireFigureFile(out.string());
  requireOther(out, {arguments.recording});
  const std::string title = arguments.title.value_or(recording.info.description);
  writeFigure(out.string(),
              arguments.signals.empty() ? runFigureSvg(recording, {}, title) : signalsFigureSvg(recording, arguments.signals, {}, title));
  fmt::print("figure  {}\n", printable(out.string()));
  return done;
}

}  // namespace

Action addFigure(CLI::App& command, ModelOptions& model) {
  auto arguments = std::make_shared<FigureArguments>();
  command.add_option("recording", arguments->recording, "Recording, NAME.csv with NAME.json beside it")->required();
  addList(command, "--signals", arguments->signals,
          "Signals to draw, one diagram per quantity; NAME* stands for all that begin so (default: the figure of a run)");
  command.add_option("-o,--out", arguments->out, "Figure to write, FILE.svg or FILE.png (default: NAME.svg)");
  command.add_option("--title", arguments->title, "Title (default: the recording's description)");
  addList(command, "--ignore-columns", arguments->ignore_columns, "Columns to skip, separated by commas");
  command.add_flag("--quiet", model.quiet, "No messages on standard error except errors");
  return [&model, arguments] { return figure(model, *arguments); };
}

}  // namespace musclesim::command_line
