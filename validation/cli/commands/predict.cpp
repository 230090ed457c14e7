#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/base/units.h"
#include "msa/fields/yaml_tree.h"
#include "validation/cli/command.h"
#include "validation/cli/devices.h"
#include "validation/cli/made_by.h"
#include "validation/cli/talk.h"
#include "validation/fit/predicted.h"
#include "validation/report/validity/predict_results.h"

namespace deflect::cli {
namespace {

struct PredictArguments {
  std::string device, at, joints, load, plan, fit, json, out, theories, sigma_mm, sigma_rad;
  double threads = 0;
};

/// One reading at one pose.
measurement::Measurements plan_of_one(measurement::Reading r, measurement::PoseGroup pose) {
  measurement::Measurements out;
  out.origin = "--at";
  r.line = 1;
  pose.label = "at";
  pose.readings = {0};
  out.readings = {std::move(r)};
  out.poses = {std::move(pose)};
  return out;
}

measurement::Measurements plan_of_machine(const Mechanism& m, const PredictArguments& a) {
  const Stand at = parse_stand(m, a.at, a.joints, false);
  measurement::Reading r;
  r.load = wrench_from_mm(parse_load(a.load));
  measurement::PoseGroup pose;
  pose.pose_mm_deg = at.pose_mm_deg;
  if (a.joints.empty()) return plan_of_one(r, pose);
  const std::vector<Actuator>& driven = at.configuration.actuators;
  pose.joints.resize(std::ssize(driven));
  for (std::size_t i = 0; i < driven.size(); ++i) pose.joints(as_index(i)) = driven[i].value;
  measurement::Measurements out = plan_of_one(r, pose);
  for (const Actuator& each : driven) out.joint_rotates.push_back(each.rotation);
  return out;
}

/// "snow=1,wind=-0.5": factors on load cases.
measurement::Measurements plan_of_frame(const subject::Subject& s, const PredictArguments& a) {
  if (!a.joints.empty() || !a.load.empty())
    throw InputError("--joints and --load are of a machine: of a frame give factors on its load cases, --at snow=1");
  const std::vector<std::string> cases = s.instruments().load_cases;
  measurement::Reading r;
  r.factors.assign(cases.size(), 0);
  for (std::size_t from = 0; from <= a.at.size();) {
    const std::size_t comma = std::min(a.at.find(',', from), a.at.size());
    const std::string word = a.at.substr(from, comma - from);
    from = comma + 1;
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const auto found = std::find(cases.begin(), cases.end(), name);
    if (equals == word.npos || found == cases.end())
      throw InputError(fmt::format("--at '{}': write factors on load cases, as in {}=1{}", a.at,
                                   cases.empty() ? "snow" : cases.front(), suggestion(name, cases)));
    r.factors[as_size(found - cases.begin())] = told_at<InputError>(
        [&] { return fmt::format("--at '{}': ", a.at); }, [&] { return parse_number(word.substr(equals + 1)); });
  }
  measurement::Measurements out = plan_of_one(r, {});
  out.instruments.load_cases = cases;
  out.instruments.stationary = true;
  return out;
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
  if (!a.fit.empty()) known = fit::read_fit(read_text(a.fit), a.fit, s);
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
      "Predict readings with 95 % intervals, at one pose under one load or for a whole plan. The interval has what is "
      "not known of parameters (from a fit), of tolerances (as the fit left them), of the load, what the fit left "
      "unexplained, and the noise of a reading; each share is told, and every theory's number",
      "deflect predict fitted.yaml --at 25,25,198.9 --load 50,0,0 --fit fit.json",
      {{"device", "DEVICE", "built-in device or frame, or a file of one", &a->device, true},
       {"--at,--pose", "x,y,z,roll,pitch,yaw|CASE=FACTOR,...",
        "pose of the tool frame in the base frame, mm and deg; of a frame factors on its load cases", &a->at},
       {"--joints", "q1,...,qn", "joint coordinates instead of --at: slides in mm, turns in rad, or with unit",
        &a->joints},
       {"--load", "fx,fy,fz,mx,my,mz", "wrench on the tool point in base axes, N and Nmm (default 0)", &a->load},
       {"--plan", "FILE", "a measurement file that gives poses and loads; its readings are not looked at", &a->plan},
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
