#include "validation/cli/commands/effects.h"

#include <fmt/format.h>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/cli/talk.h"
#include "validation/effects/effect_file.h"
#include "validation/effects/place_effects.h"
#include "validation/report/effect_results.h"

namespace deflect::cli {

std::vector<effects::Effect> known_effects(const std::vector<std::string>& files) {
  std::vector<effects::Effect> all = effects::catalogue(data_folder() / "effects" / "catalogue");
  tell("effects: {} from {}", all.size(), (data_folder() / "effects" / "catalogue").string());
  for (const std::string& file : files) {
    effects::add_effect(all, effects::read_effect(file));
    tell("effect {} from {}", all.back().name, file);
  }
  return all;
}

std::vector<effects::Effect> known_effects(const std::vector<std::string>& files, const subject::Subject& subject) {
  std::vector<effects::Effect> all = known_effects(files);
  for (effects::Effect& e : effects::place_effects(subject, all)) all.push_back(std::move(e));
  return all;
}

namespace {

struct EffectsArguments {
  std::string name, device, json;
  std::vector<std::string> files;
  bool yaml = false;
};

void run(const EffectsArguments& a) {
  std::optional<subject::Subject> device;
  if (!a.device.empty()) device = read_subject(a.device);
  std::vector<effects::Effect> all = device ? known_effects(a.files, *device) : known_effects(a.files);
  if (!device && a.name.find('@') != a.name.npos)
    throw InputError(fmt::format("{}: a law at a place belongs to a device: name it with --device", a.name));
  if (!a.name.empty()) all = {effects::find_effect(all, a.name)};
  if (a.yaml) {
    if (a.name.empty()) throw InputError("--yaml prints the file of one effect: name it");
    fmt::print("{}", all.front().place ? effects::write_effect(all.front()) : read_text(all.front().origin));
    return;
  }
  if (!a.json.empty()) write_file(a.json, report::effects_json(all, device));
  if (!a.name.empty())
    fmt::print("{}", report::effect_page(all.front()));
  else if (!device)
    fmt::print("{}", report::effect_table(all));
  if (device) fmt::print("{}{}", a.name.empty() ? "" : "\n", report::effects_in_device(all, *device));
}

}  // namespace

Command effects_command() {
  auto a = std::make_shared<EffectsArguments>();
  return {"effects",
          "List the effects that a model can lack, or explain one: what happens in the machine, what the data show, "
          "how to confirm it on the bench, how to cure it. With --device, also the laws at the device's places "
          "(LAW@PLACE). With --yaml, print the effect's file to start your own from",
          "deflect effects guide_root_compliance --device haptic-6psu",
          {{"name", "EFFECT", "effect to explain (default: list all)", &a->name},
           {"--device", "DEVICE",
            "list the effects that this device or frame can have, and why it cannot have the others", &a->device},
           {"--effects", "FILE", "your own effect files, in addition to the catalogue", &a->files},
           {"--yaml", "", "print the effect's file", &a->yaml},
           {"--json", "FILE", "write the effects", &a->json}},
          [a] { run(*a); }};
}

}  // namespace deflect::cli
