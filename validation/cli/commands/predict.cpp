#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/outcome.h"
#include "msa/base/units.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/cli/made_by.h"
#include "validation/cli/talk.h"
#include "validation/fit/plan_of_one.h"
#include "validation/fit/predicted.h"
#include "validation/report/validity/predict_results.h"

namespace deflect::cli {
namespace {

struct PredictArguments {
  std::string device, at, joints, load, plan, fit, json, out, theories, sigma_mm, sigma_rad;
  double threads = 0;
};

/// "snow=1,wind=-0.5": factors on load cases.
std::vector<std::pair<std::string, double>> parse_factors(const std::string& text, const std::string& example) {
  std::vector<std::pair<std::string, double>> out;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const std::string word = text.substr(from, comma - from);
    from = comma + 1;
    const std::size_t equals = word.find('=');
    if (equals == word.npos) throw InputError(fmt::format("write factors on load cases, as in {}=1", example));
    out.emplace_back(word.substr(0, equals), parse_number(word.substr(equals + 1)));
  }
  return out;
}

measurement::Measurements plan_of_frame(const subject::Subject& s, const PredictArguments& a) {
  if (!a.joints.empty() || !a.load.empty())
    throw InputError("--joints and --load are of a machine: of a frame give factors on its load cases, --at snow=1");
  const std::vector<std::string> cases = s.instruments().load_cases;
  return told_at<InputError>(
      [&] { return fmt::format("--at '{}': ", a.at); },
      [&] { return fit::plan_of_one(s, parse_factors(a.at, cases.empty() ? "snow" : cases.front())); });
}

measurement::Measurements plan_of_machine(const Mechanism& m, const PredictArguments& a) {
  const Stand at = parse_stand(m, a.at, a.joints, false);
  return fit::plan_of_one(at, wrench_from_mm(parse_load(a.load)), !a.joints.empty());
}

measurement::Measurements plan_of(const subject::Subject& s, const PredictArguments& a) {
  const bool at = !a.at.empty() || !a.joints.empty();
  if (at != a.plan.empty())
    throw InputError(fmt::format("give either {} or --plan FILE",
                                 s.frame() ? "--at CASE=FACTOR,..." : "--at POSE (or --joints) with --load"));
  if (!a.plan.empty()) {
    if (!a.load.empty()) throw InputError("--load goes with --at: the plan has its own loads");
    return read_plan(a.plan, s);
  }
  return s.frame() ? plan_of_frame(s, a) : plan_of_machine(*s.machine(), a);
}

void run(const PredictArguments& a) {
  const subject::Subject s = read_subject(a.device);
  const measurement::Measurements plan = plan_of(s, a);
  std::optional<fit::Knowledge> known;
  if (!a.fit.empty()) {
    known = fit::read_fit(read_text(a.fit), a.fit, s);
    remark_if_of_another(a.fit, a.device, s);
  }
  fit::PredictedPlanOptions o;
  o.theories = parse_theories(a.theories);
  o.sigma_u = parse_sigma("--sigma", a.sigma_mm, "mm", 1e3);
  o.sigma_th = parse_sigma("--sigma-rotation", a.sigma_rad, "rad", 1);
  const int threads = parse_threads(a.threads);
  const fit::PredictedPlan p = timed_with_progress("predict: every reading, tolerances", [&](const auto& told) {
    return fit::predict(s, plan, known, o, {threads, nullptr, told});
  });
  const std::filesystem::path folder = a.out;
  if (!a.out.empty()) write_table(folder / "predicted.csv", report::predict_csv(p));
  if (!a.json.empty()) write_result(a.json, report::predict_json(p));
  fmt::print("{}", report::predict_report(p));
}

}  // namespace

Command predict_command() {
  auto a = std::make_shared<PredictArguments>();
  return {
      "predict",
      "Predict readings with 95 % intervals, at one pose under one load or for a whole plan. The interval covers the "
      "uncertainty of parameters (from a fit), of tolerances (as the fit left them) and of the load, what the fit left "
      "unexplained, and the noise of a reading. The report gives each share, and every theory's number. A machine is "
      "predicted in the deformed shape (finite, where its file names no geometry; 'solve' is linear without "
      "--geometry), a frame in the geometry of its file. What the deformed shape adds to the linear prediction counts "
      "among the tolerances with a standard deviation of a fifth of it",
      "deflect predict fitted.yaml --at 25,25,198.9 --load 50,0,0 --fit fit.json",
      {{"device", "DEVICE", "built-in device or frame, or a file of one", &a->device, true},
       {"--at,--pose", "x,y,z,roll,pitch,yaw|CASE=FACTOR,...",
        "pose of the tool frame in the base frame, mm and deg; of a frame factors on its load cases", &a->at},
       {"--joints", "q1,...,qn", "joint coordinates instead of --at: slides in mm, turns in rad, or with unit",
        &a->joints},
       {"--load", "fx,fy,fz,mx,my,mz", "wrench on the tool point in base axes, N and Nmm (default 0)", &a->load},
       {"--plan", "FILE", "a measurement file that gives poses and loads; its readings are ignored", &a->plan},
       {"--fit", "FIT.json", "the result of 'deflect fit --json' for this description", &a->fit},
       theories_option(&a->theories),
       {"--sigma", "MM", "standard deviation of a translation in mm, where neither sensor nor fit has it",
        &a->sigma_mm},
       {"--sigma-rotation", "RAD", "standard deviation of a rotation in rad, likewise", &a->sigma_rad},
       {"--threads", "N", "threads (default 0: all cores); they do not change the result", &a->threads},
       {"--json", "FILE", "write the result", &a->json},
       {"--out", "DIR", "write the table (predicted.csv)", &a->out}},
      [a] { run(*a); }};
}

}  // namespace deflect::cli
