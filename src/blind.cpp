/// `musclesim blind make`: the check of the diagnosis on withheld causes.
#include <fmt/format.h>

#include "commands.h"
#include "diagnosis/blind/make.h"
#include "interrupt.h"
#include "progress.h"

namespace musclesim::program {

namespace {

struct BlindArguments {
  std::string folder, keys, commit;
  blind::MakeOptions make;
  bool quiet = false;
};

int makeCases(BlindArguments& arguments) {
  PhaseProgress progress(arguments.quiet);
  arguments.make.commit = arguments.commit;
  arguments.make.interrupted = [] { return interruptSignal() != 0; };
  arguments.make.progress = [&](int done, int count) { progress.show("cases made", done, count); };
  const auto key = blind::make(arguments.folder, arguments.keys, arguments.make);
  if (interruptSignal() != 0) return interrupted_base + interruptSignal();
  fmt::print("cases   {}\nkey     {}\nseal    {}/seal.json\n", arguments.make.count + arguments.make.arm_count, key.string(),
             arguments.folder);
  return done;
}

Action addMake(CLI::App& command) {
  auto arguments = std::make_shared<BlindArguments>();
  command.add_option("folder", arguments->folder, "New folder for the cases and the seal")->required();
  command.add_option("--keys", arguments->keys, "Folder for the key, out of reach of `blind run`")->required();
  command.add_option("--count", arguments->make.count, "Cases on rig and elbow in turn (default 120)");
  command.add_option("--arm-count", arguments->make.arm_count, "Further cases on the arm (default 12)");
  command.add_option("--seed", arguments->make.seed, "Of all draws (default 1)");
  command.add_option("--duration-s", arguments->make.duration_s, "Of each recording (default 6); half of it on the arm");
  command.add_option("--kinds", arguments->make.kinds, "Only these: single, double, open, null")->delimiter(',');
  command.add_option("--jobs", arguments->make.job_count, "Threads (default: one per core); the cases do not depend on it")
      ->check(CLI::Range(1, 1024));
  command.add_option("--commit", arguments->commit, "Version of the sources, noted in the seal");
  command.add_flag("--quiet", arguments->quiet, "No progress line");
  return [arguments] { return makeCases(*arguments); };
}

}  // namespace

Action addBlind(CLI::App& command) {
  command.require_subcommand(1);
  CLI::App* make = command.add_subcommand("make", "Draws plants with withheld causes, records them and seals the key");
  const Action make_action = addMake(*make);
  return [=] { return make_action(); };
}

}  // namespace musclesim::program
