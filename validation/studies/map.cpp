#include "validation/studies/map.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/mechanism/configuration.h"
#include "validation/parallel/journal.h"
#include "validation/parallel/pack.h"
#include "validation/studies/sweep.h"
#include "validation/theories/agreement.h"

namespace deflect::studies {

template <class Archive>
void serialize(Archive& a, MapValues& v) {
  a(v.compliance_mm_N, v.stiffness_N_mm, v.K_ii, v.smallest_N_mm, v.largest_N_mm, v.isotropy);
}

template <class Archive>
void serialize(Archive& a, MapPose& p) {
  a(p.pose_mm_deg, p.out_of_reach, p.reason, p.slide_min_mm, p.slide_mean_mm, p.slide_max_mm, p.values,
    p.relative_difference);
}

namespace {

/// Poses that a thread takes at a time.
std::size_t chunk_of(std::size_t poses) { return std::clamp<std::size_t>(poses / 64, 4, 128); }

/// (C_δδ)⁻¹ as the Schur complement of the rotations: no inverse of a K that may be singular. N/mm.
Matrix3 translational(const Matrix6& K_mm) {
  const Matrix3 K_tt = K_mm.bottomRightCorner<3, 3>();
  const Matrix3 S = K_mm.topLeftCorner<3, 3>() -
                    K_mm.topRightCorner<3, 3>() *
                        Matrix3(K_tt.completeOrthogonalDecomposition().solve(Matrix3(K_mm.bottomLeftCorner<3, 3>())));
  return (S + S.transpose()) / 2;
}

/// Widens the extremes by one state.
void add(MapValues& v, const Matrix6& K_SI, double length_mm) {
  const Matrix6 K = stiffness_in_mm(K_SI);
  const Vector3 s = Eigen::SelfAdjointEigenSolver<Matrix3>(translational(K), Eigen::EigenvaluesOnly).eigenvalues();
  v.smallest_N_mm = std::min(v.smallest_N_mm, s(0));
  v.largest_N_mm = std::max(v.largest_N_mm, s(2));
  Vector6 weight = Vector6::Ones();
  weight.tail<3>().setConstant(1 / length_mm);
  const Matrix6 weighed = weight.asDiagonal() * ((K + K.transpose()) / 2) * weight.asDiagonal();
  const Vector6 e = Eigen::SelfAdjointEigenSolver<Matrix6>(weighed, Eigen::EigenvaluesOnly).eigenvalues();
  v.isotropy = std::min(v.isotropy, e(5) > 0 ? std::max(e(0), 0.0) / e(5) : 0.0);
}

MapValues empty_values() {
  MapValues v;
  v.smallest_N_mm = std::numeric_limits<double>::infinity();
  v.isotropy = 1;
  return v;
}

/// Of one theory, of its answers to each load.
MapValues values_of(const std::vector<std::vector<theories::Answer>>& by_load, std::size_t theory,
                    const MapOptions& o) {
  MapValues v = empty_values();
  const auto state = [&](std::size_t load) -> const theories::Answer& { return by_load[load][theory]; };
  for (std::size_t i = 0; i < by_load.size(); ++i) add(v, state(i).stiffness, o.length_mm);
  for (int i = 0; i < 3; ++i) {
    const Matrix6 K = stiffness_in_mm(state(o.load_N_Nmm ? 0 : as_size(i)).stiffness);
    v.K_ii(i) = K(i, i);
    v.K_ii(i + 3) = K(i + 3, i + 3);
  }
  if (o.load_N_Nmm) {
    v.compliance_mm_N = translational(stiffness_in_mm(state(0).stiffness)).inverse();
  } else {
    for (std::size_t j = 0; j < 3; ++j)
      v.compliance_mm_N.col(as_index(j)) = twist_in_mm(state(j).displacement).head<3>() / o.force_N;
  }
  v.stiffness_N_mm = v.compliance_mm_N.diagonal().cwiseInverse();
  return v;
}

void check_finite(const MapValues& v, const Mechanism& m, const Vector6& pose_mm_deg, const theories::Theory& theory) {
  if (v.compliance_mm_N.allFinite() && v.stiffness_N_mm.allFinite() && v.K_ii.allFinite() &&
      std::isfinite(v.smallest_N_mm) && std::isfinite(v.largest_N_mm) && std::isfinite(v.isotropy))
    return;
  throw ModelError(fmt::format("{} at ({}): the {} stiffness is singular: a force there meets no resistance", m.name,
                               fmt::join(pose_mm_deg, ", "), theory.title));
}

std::vector<Vector6> loads_of(const MapOptions& o) {
  if (o.load_N_Nmm) return {wrench_from_mm(*o.load_N_Nmm)};
  return {o.force_N * Vector6::Unit(0), o.force_N * Vector6::Unit(1), o.force_N * Vector6::Unit(2)};
}

void tell_slides(MapPose& out, const Configuration& c) {
  double slides = 0;
  for (const Actuator& actuator : c.actuators) {
    if (actuator.rotation) continue;
    const double q = 1e3 * actuator.value;
    out.slide_min_mm = slides == 0 ? q : std::min(out.slide_min_mm, q);
    out.slide_max_mm = slides == 0 ? q : std::max(out.slide_max_mm, q);
    out.slide_mean_mm += q;
    ++slides;
  }
  if (slides > 0) out.slide_mean_mm /= slides;
}

MapPose map_pose(Sweep& sweep, const Mechanism& m, const MapOptions& o, const std::vector<Vector6>& loads,
                 std::size_t index) {
  MapPose out;
  out.pose_mm_deg = o.grid.pose_mm_deg(index);
  if (o.region && !o.region->holds(out.pose_mm_deg.head<3>())) {
    out.out_of_reach = "outside the workspace, a " + o.region->words;
    out.reason = out.out_of_reach;  // the same everywhere, its numbers too
    return out;
  }
  const auto stands = outcome_of<ModelError>([&] { return &sweep.at(out.pose_mm_deg); });
  if (!stands) {
    out.out_of_reach = stands.why;
    out.reason = stands.cause.reason.empty() ? stands.why : stands.cause.reason;
    return out;
  }
  const Configuration* c = *stands;
  tell_slides(out, *c);
  std::vector<std::vector<theories::Answer>> by_load(loads.size());
  for (std::size_t t = 0; t < o.theories.size(); ++t) {
    for (std::size_t i = 0; i < loads.size(); ++i) by_load[i].push_back(sweep.answer(t, loads[i]));
    out.values.push_back(values_of(by_load, t, o));
    check_finite(out.values.back(), m, out.pose_mm_deg, *o.theories[t]);
  }
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const std::vector<theories::Answer>& answers = by_load[i];
    theories::require_agreement(o.theories, answers, loads[i], *c, m.name);
    std::vector<Vector6> displacements;
    for (const theories::Answer& answer : answers) displacements.push_back(twist_in_mm(answer.displacement));
    out.relative_difference = std::max(out.relative_difference, theories::largest_difference(displacements));
  }
  return out;
}

void check(const MapOptions& o) {
  const char* names[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    const double low = o.grid.low_mm(i), high = o.grid.high_mm(i);
    const int n = nth(o.grid.counts, i);
    if (n < 1) throw InputError(fmt::format("the grid has {} values of {}: at least 1 is wanted", n, names[i]));
    if (!std::isfinite(low) || !std::isfinite(high) || low > high)
      throw InputError(fmt::format("the range of {} is {} to {} mm: finite numbers are wanted, the smaller first",
                                   names[i], low, high));
    if (n > 1 && low == high)
      throw InputError(
          fmt::format("the range of {} is one value, {} mm, and the grid wants {} of them: give 1 or a "
                      "wider range",
                      names[i], low, n));
  }
  if (o.grid.size() > 10'000'000)
    throw InputError(fmt::format("the grid has {} poses: at most 10 million are wanted", o.grid.size()));
  if (!o.grid.tilt_deg.allFinite()) throw InputError("the tilt is not finite");
  if (!std::isfinite(o.force_N) || o.force_N == 0)
    throw InputError(fmt::format("the force is {} N: a number other than zero is wanted", o.force_N));
  if (o.load_N_Nmm && (!o.load_N_Nmm->allFinite() || o.load_N_Nmm->isZero(0)))
    throw InputError("the load must be finite and other than zero: without load a contact has no stiffness");
  if (!(o.length_mm > 0) || !std::isfinite(o.length_mm))
    throw InputError(fmt::format("the characteristic length is {} mm: a positive number is wanted", o.length_mm));
  if (o.theories.empty()) throw InputError("a map wants at least one theory");
}

}  // namespace

std::size_t MapGrid::size() const {
  std::size_t n = 1;
  for (const int count : counts) n *= as_size(count);
  return n;
}

std::size_t MapGrid::index(int i, int j, int k) const {
  return as_size(i) + as_size(counts[0]) * (as_size(j) + as_size(counts[1]) * as_size(k));
}

double MapGrid::coordinate(int axis, int i) const {
  const int n = nth(counts, axis);
  return std::lerp(low_mm(axis), high_mm(axis), n == 1 ? 0.5 : static_cast<double>(i) / (n - 1));
}

Vector6 MapGrid::pose_mm_deg(std::size_t index) const {
  Vector6 pose;
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = as_size(nth(counts, axis));
    pose(axis) = coordinate(axis, static_cast<int>(index % n));
    index /= n;
  }
  pose.tail<3>() = tilt_deg;
  return pose;
}

MapGrid workspace_grid(const Mechanism& m, const std::array<int, 3>& counts) {
  const Region r = region_of(m);
  MapGrid grid{r.low_mm, r.high_mm, counts, r.centre_mm_deg.tail<3>()};
  for (Eigen::Index i = 0; i < 3; ++i)
    if (grid.low_mm(i) == grid.high_mm(i)) nth(grid.counts, i) = 1;
  return grid;
}

double weighing_length_mm(const Mechanism& m) {
  const auto* k = std::get_if<SixPsu>(&m.kinematics);
  return 1e3 * (k ? k->platform_radius : configure(m, home_pose(m)).size);
}

SlideWords slide_words(const Mechanism& m) {
  if (std::holds_alternative<SixPsu>(m.kinematics)) return {"guide", "guideway length"};
  const std::vector<Actuator> all = actuators_of(m);
  const bool slides = std::any_of(all.begin(), all.end(), [](const Actuator& a) { return !a.rotation; });
  return slides ? SlideWords{"slide", "slide position"} : SlideWords();
}

StiffnessMap map_stiffness(const Mechanism& m, const MapOptions& options, const parallel::Work& work) {
  check(options);
  if (work.threads < 0) throw InputError(fmt::format("{} threads: 0 (all) or more are wanted", work.threads));
  StiffnessMap map{m.name, slide_words(m), options, std::vector<MapPose>(options.grid.size())};
  const std::vector<Vector6> loads = loads_of(options);
  const std::size_t poses = map.poses.size(), chunk = chunk_of(poses);
  const auto progress = [&](std::size_t done) {
    work.progress(static_cast<double>(std::min(poses, done * chunk)) / static_cast<double>(poses));
  };
  const auto of_chunk = [&](std::size_t k) {
    return std::span(map.poses).subspan(k * chunk, std::min(chunk, poses - k * chunk));
  };
  parallel::SharedCases chunks;
  chunks.count = (poses + chunk - 1) / chunk;
  chunks.work = [&](std::size_t k) {
    Sweep sweep(m, options.theories);
    for (std::size_t i = k * chunk; MapPose & pose : of_chunk(k)) pose = map_pose(sweep, m, options, loads, i++);
  };
  chunks.result = [&](std::size_t k) {
    const auto done = of_chunk(k);
    return parallel::pack(std::vector<MapPose>(done.begin(), done.end()));
  };
  chunks.take = [&](std::size_t k, const std::string& bytes) {
    std::ranges::move(parallel::unpack<std::vector<MapPose>>(bytes), of_chunk(k).begin());
  };
  parallel::for_each_case(chunks, work.journal, 0, work.ranks, work.threads,
                          work.progress ? std::function<void(std::size_t)>(progress) : nullptr);
  return map;
}

}  // namespace deflect::studies
