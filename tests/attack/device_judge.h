// What both theories say of a device, judged by the force method.
#pragma once

#include <cstring>
#include <functional>
#include <string>
#include <type_traits>

#include "tests/attack/device_oracle.h"
#include "tests/attack/frame_judge.h"
#include "tests/attack/random_device.h"

namespace deflect::attack {

/// What is right: an answer; a refusal because the platform moves freely or nothing yields at all; either where single
/// directions are rigid (the displacement is known, the stiffness infinite).
enum class DeviceClass { stands, idle, partly_rigid, rigid, moves, unclear };
inline constexpr const char* device_class_names[] = {
    "stands", "stands, inner bodies idle", "partly rigid", "rigid", "moves", "unclear"};

struct DeviceJudgement {
  Outcome outcome = Outcome::answered;
  DeviceClass kind = DeviceClass::stands;
  double condition = 1;
  double error = 0;                        ///< of displacements, the worse theory, relative
  double stiffness_error = 0;              ///< of K, the worse theory, relative
  double between = 0;                      ///< of the theories' displacements
  Vector6 displacement = Vector6::Zero();  ///< m, rad; of the MSA
  std::string words;
};

/// `solve` of validation/compare/theories.h at home under the device's load.
DeviceJudgement judge(const RandomDevice&);

/// Where laws are not linear: both theories must agree, or the program must name the cause; that it did not converge is
/// none.
DeviceJudgement judge_agreement(const RandomDevice&);

/// One of these in a process of its own, so that a signal (also that of 20 s of the processor without an end) is an
/// outcome: crashed.
DeviceJudgement judge_apart(const RandomDevice&, DeviceJudgement (*)(const RandomDevice&) = judge);

/// What `tell` says in a process of its own, or why that died.
struct FromChild {
  std::string told, died;
};
FromChild in_child(const std::function<std::string()>& tell);

/// Plain numbers as what can be told.
template <class Numbers>
requires std::is_trivially_copyable_v<Numbers> std::string bytes_of(const Numbers& numbers) {
  std::string out(sizeof numbers, 0);
  std::memcpy(out.data(), &numbers, sizeof numbers);
  return out;
}
template <class Numbers>
requires std::is_trivially_copyable_v<Numbers> Numbers from_bytes(const std::string& told) {
  Numbers out{};
  std::memcpy(&out, told.data(), sizeof out);
  return out;
}

std::string reproduction(const RandomDevice&, const DeviceJudgement&);

}  // namespace deflect::attack
