#include "rig/limb_names.h"

#include <algorithm>
#include <limits>

namespace remomask::rig {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// How badly a part's name suits each joint of a limb, and what it costs to leave it out: a name
/// with one meaning is missed, one with two is not.
struct Suitability {
  std::array<double, 4> as = {kNever, kNever, kNever, kNever};
  double left_out = 0;
};

Suitability leg_suitability(const NameReading& name) {
  switch (name.part) {
    case BodyPart::hip:
      return {{name.connector ? 3. : 1., kNever, kNever, kNever}, 0.5};
    case BodyPart::thigh:
      return {{0, kNever, kNever, kNever}, 3};
    case BodyPart::leg:
      return {{2, 2, kNever, kNever}, 1};
    case BodyPart::shin:
      return {{kNever, 0, kNever, kNever}, 3};
    case BodyPart::ankle:
      return {{kNever, kNever, 0, kNever}, 3};
    case BodyPart::foot:
      return {{kNever, kNever, 1, 2}, 1};
    case BodyPart::heel:
      return {{kNever, kNever, 4, kNever}, 0.5};
    case BodyPart::toe:
      return {{kNever, kNever, kNever, name.end ? 2. : 0.}, 1};
    default:
      return {};
  }
}

Suitability arm_suitability(const NameReading& name) {
  switch (name.part) {
    case BodyPart::collar:
      return {{0, kNever, kNever, kNever}, 1};
    case BodyPart::shoulder:
      return {{1, 1, kNever, kNever}, 1};
    case BodyPart::upper_arm:
      return {{kNever, 0, kNever, kNever}, 3};
    case BodyPart::arm:
      return {{kNever, 1, 3, kNever}, 1};
    case BodyPart::forearm:
      return {{kNever, kNever, 0, kNever}, 3};
    case BodyPart::wrist:
      return {{kNever, kNever, kNever, 0}, 2};
    case BodyPart::hand:
      return {{kNever, kNever, kNever, name.end ? 4. : 1.}, 0.5};
    default:
      return {};
  }
}

using SuitabilityOf = Suitability (*)(const NameReading&);

struct LimbReading {
  LimbJoints joints = {-1, -1, -1, -1};
  double cost = kNever;
};

/// What it costs that a limb lacks a joint: collars, toes and hands may be absent.
double cost_of_absence(const LimbJoints& joints, const LimbJoints& needed) {
  double cost = 0;
  for (size_t role = 0; role < joints.size(); ++role) {
    if (joints[role] < 0) cost += needed[role] ? 20 : 1.5;
  }
  return cost;
}

/// The cheapest reading of a chain of joints, in their order from the body outwards.
struct ChainReader {
  const std::vector<NameReading>& names;
  const std::vector<int>& chain;
  SuitabilityOf suitability;
  LimbJoints needed;
  LimbReading best;

  void read(size_t at, int last_role, const LimbJoints& joints, double cost) {
    if (cost >= best.cost) return;
    if (at == chain.size()) {
      cost += cost_of_absence(joints, needed);
      if (cost < best.cost) best = {joints, cost};
      return;
    }
    const NameReading& name = names[static_cast<size_t>(chain[at])];
    const Suitability suits = suitability(name);
    for (int role = last_role + 1; role < 4; ++role) {
      const double price = suits.as[static_cast<size_t>(role)];
      if (price == kNever) continue;
      LimbJoints with = joints;
      with[static_cast<size_t>(role)] = chain[at];
      read(at + 1, role, with, cost + price + 1.5 * name.strange_words);
    }
    // A second piece of the same bone ("thigh.001") is not missed.
    bool repeated = name.strange_words > 0;
    for (int role = 0; role <= last_role; ++role) {
      repeated |= suits.as[static_cast<size_t>(role)] != kNever;
    }
    read(at + 1, last_role, joints, cost + (repeated ? 0.1 : suits.left_out));
  }
};

int outward_order(BodyPart part) { return static_cast<int>(part); }

/// Reads the limb along every path that ends in one of its joints, and takes the cheapest. Ties
/// come from toes side by side: the first by name is the big one, whatever the order of the file.
LimbReading read_limb(const SkeletonView& skeleton, const std::vector<NameReading>& names,
                      Side side, SuitabilityOf suitability, const LimbJoints& needed) {
  const auto belongs = [&](int joint) {
    const NameReading& name = names[static_cast<size_t>(joint)];
    if (name.side != side || name.helper) return false;
    const Suitability suits = suitability(name);
    return std::any_of(suits.as.begin(), suits.as.end(), [](double c) { return c != kNever; });
  };
  std::vector<int> members;
  for (size_t j = 0; j < skeleton.size(); ++j) {
    if (belongs(static_cast<int>(j))) members.push_back(static_cast<int>(j));
  }
  const auto read = [&](const std::vector<int>& chain) {
    ChainReader reader{names, chain, suitability, needed, {}};
    reader.read(0, -1, {-1, -1, -1, -1}, 0);
    return reader.best;
  };
  std::vector<LimbReading> cheapest;
  for (const int end : members) {
    std::vector<int> chain;
    for (const int joint : skeleton.path_to_root(end)) {
      if (belongs(joint)) chain.insert(chain.begin(), joint);
    }
    if (chain.size() > 16) chain.resize(16);
    const LimbReading reading = read(chain);
    if (!cheapest.empty() && reading.cost > cheapest[0].cost) continue;
    if (!cheapest.empty() && reading.cost < cheapest[0].cost) cheapest.clear();
    cheapest.push_back(reading);
  }
  LimbReading best;
  for (const LimbReading& reading : cheapest) {
    const auto last_name = [&](const LimbReading& limb) {
      const int last = *std::find_if(limb.joints.rbegin(), limb.joints.rend(),
                                     [](int joint) { return joint >= 0; });
      return skeleton.names[static_cast<size_t>(last)];
    };
    if (best.cost == kNever || last_name(reading) < last_name(best)) best = reading;
  }
  // Joints that do not hang in a chain (an exporter's flat list) are in the order of their names.
  if (best.cost >= 20 && members.size() > 1 && members.size() <= 16) {
    std::stable_sort(members.begin(), members.end(), [&](int a, int b) {
      const NameReading &first = names[static_cast<size_t>(a)],
                        &second = names[static_cast<size_t>(b)];
      if (first.part != second.part) return outward_order(first.part) < outward_order(second.part);
      return first.number < second.number;
    });
    const LimbReading flat = read(members);
    if (flat.cost < best.cost) best = flat;
  }
  return best;
}

}  // namespace

LimbJoints find_leg(const SkeletonView& skeleton, const std::vector<NameReading>& names,
                    Side side) {
  return read_limb(skeleton, names, side, leg_suitability, {1, 1, 1, 0}).joints;
}

LimbJoints find_arm(const SkeletonView& skeleton, const std::vector<NameReading>& names,
                    Side side) {
  return read_limb(skeleton, names, side, arm_suitability, {0, 1, 1, 0}).joints;
}

}  // namespace remomask::rig
