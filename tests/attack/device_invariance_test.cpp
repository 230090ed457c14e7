// The same random devices in other words must get the same answers: other sizes, another unit of force, legs in another
// order, turned base axes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/attack/count.h"
#include "tests/attack/device_judge.h"
#include "tests/attack/frame_forms.h"
#include "tests/support/apart.h"

namespace deflect::attack {
namespace {

struct Form {
  std::string name;
  RandomDevice device;
  std::function<Vector6(const Vector6&)> restored;  ///< a displacement of T as the first device has it
};

std::vector<Form> forms_of(const RandomDevice& d) {
  Dice dice(d.seed + 4711);
  const Matrix3 R = any_rotation(dice);
  const auto sized = [](double s) {
    return [s](Vector6 u) {
      u.head<3>() /= s;
      return u;
    };
  };
  const auto same = [](const Vector6& u) { return u; };
  const auto back = [R](const Vector6& u) {
    Vector6 out;
    out << R.transpose() * u.head<3>(), R.transpose() * u.tail<3>();
    return out;
  };
  return {{"1000 times larger", scaled(d, 1e3), sized(1e3)},
          {"1000 times smaller", scaled(d, 1e-3), sized(1e-3)},
          {"forces in lbf", in_force_unit(d, 1 / 4.4482216152605), same},
          {"legs in another order", reordered(d), same},
          {"turned", turned(d, R), back}};
}

class DeviceInvariance : public ::testing::TestWithParam<unsigned> {};

TEST_P(DeviceInvariance, TheSameDeviceInOtherWordsGetsTheSameAnswer) {
  for (unsigned seed = GetParam(); seed < usual_count; seed += shards) {
    const RandomDevice device = random_device(seed);
    const DeviceJudgement first = judge_apart(device);
    if (is_wrong(first.outcome)) continue;  // judged elsewhere
    for (const Form& form : forms_of(device)) {
      const DeviceJudgement again = judge_apart(form.device);
      const bool answered = first.outcome == Outcome::answered;
      const double off = answered ? test::apart(form.restored(again.displacement), first.displacement, device.unit) : 0;
      if (again.outcome == first.outcome && off <= 2 * allowed_error(first.condition, false) + 1e-9) continue;
      ADD_FAILURE() << form.name << ": " << outcome_names[static_cast<int>(first.outcome)] << " before, then "
                    << fmt::format("{:.1e} off\n", off) << reproduction(form.device, again);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shard, DeviceInvariance, ::testing::Range(0u, shards));

}  // namespace
}  // namespace deflect::attack
