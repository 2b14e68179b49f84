#include "rig/mannequin.h"

#include <algorithm>
#include <cmath>

#include "motion/body_joints.h"

namespace remomask::rig {

namespace {

using enum motion::BodyJoint;

/// How much two joints move a ring: `share` of it goes to the second.
struct Hold {
  int first = 0;
  int second = 0;
  double share = 0;
};

/// An ellipse that a tube passes through.
struct Ring {
  Vec3 centre, right, up;  ///< half axes; right x up points along the tube
  Hold hold;
};

constexpr int kSides = 10;

class Sculptor {
 public:
  /// A closed tube through rings. `blunt` closes an end by a flat cap instead of a rounded one.
  void tube(Surface surface, const std::vector<Ring>& rings) {
    const size_t first = mesh.positions.size();
    std::vector<uint16_t>& triangles = part(surface).triangles;
    const Vec3 start = rings.front().centre, end = rings.back().centre;
    for (const Ring& ring : rings) {
      for (int side = 0; side < kSides; ++side) {
        const double angle = 2 * M_PI * side / kSides;
        vertex(ring.centre + std::cos(angle) * ring.right + std::sin(angle) * ring.up, ring.hold);
      }
    }
    vertex(start, rings.front().hold);
    vertex(end, rings.back().hold);
    const size_t bottom = mesh.positions.size() - 2, top = bottom + 1;
    const auto at = [&](size_t ring, int side) {
      return static_cast<uint16_t>(first + ring * kSides + side % kSides);
    };
    const auto triangle = [&](uint16_t a, uint16_t b, uint16_t c) {
      triangles.insert(triangles.end(), {a, b, c});
    };
    for (int side = 0; side < kSides; ++side) {
      for (size_t ring = 0; ring + 1 < rings.size(); ++ring) {
        triangle(at(ring, side), at(ring, side + 1), at(ring + 1, side + 1));
        triangle(at(ring, side), at(ring + 1, side + 1), at(ring + 1, side));
      }
      triangle(static_cast<uint16_t>(bottom), at(0, side + 1), at(0, side));
      triangle(static_cast<uint16_t>(top), at(rings.size() - 1, side),
               at(rings.size() - 1, side + 1));
    }
  }

  /// An ellipsoid around `centre` with its poles along `up`.
  void ellipsoid(Surface surface, const Vec3& centre, const Vec3& right, const Vec3& up,
                 const Vec3& front, int joint) {
    constexpr int kRings = 7;
    std::vector<Ring> rings;
    for (int i = 0; i < kRings; ++i) {
      const double angle = M_PI * ((i + 0.3) / (kRings - 0.4) - 0.5);
      rings.push_back({centre + std::sin(angle) * up,
                       std::cos(angle) * front,
                       std::cos(angle) * right,
                       {joint, joint, 0}});
    }
    tube(surface, rings);
  }

  SkinnedMesh finish() {
    mesh.normals.resize(mesh.positions.size());
    std::vector<Vec3> sums(mesh.positions.size(), Vec3::Zero());
    const auto point = [&](uint16_t i) {
      return Vec3(mesh.positions[i][0], mesh.positions[i][1], mesh.positions[i][2]);
    };
    for (const SkinnedMesh::Part& each : mesh.parts) {
      for (size_t i = 0; i + 2 < each.triangles.size(); i += 3) {
        const uint16_t* corner = each.triangles.data() + i;
        const Vec3 area =
            (point(corner[1]) - point(corner[0])).cross(point(corner[2]) - point(corner[0]));
        for (int k = 0; k < 3; ++k) sums[corner[k]] += area;
      }
    }
    for (size_t i = 0; i < sums.size(); ++i) {
      const Vec3 normal = sums[i].norm() > 1e-12 ? Vec3(sums[i].normalized()) : Vec3::UnitY();
      for (int axis = 0; axis < 3; ++axis) mesh.normals[i][axis] = static_cast<float>(normal[axis]);
    }
    return std::move(mesh);
  }

 private:
  SkinnedMesh::Part& part(Surface surface) {
    for (SkinnedMesh::Part& each : mesh.parts) {
      if (each.surface == surface) return each;
    }
    mesh.parts.push_back({surface, {}});
    return mesh.parts.back();
  }

  void vertex(const Vec3& p, const Hold& hold) {
    mesh.positions.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    const auto share = static_cast<float>(hold.first == hold.second ? 0 : hold.share);
    const auto joint = [](int j) { return static_cast<uint8_t>(j); };
    mesh.joints.push_back({share < 1 ? joint(hold.first) : joint(hold.second),
                           share > 0 && share < 1 ? joint(hold.second) : joint(0), 0, 0});
    mesh.weights.push_back(
        {share < 1 ? 1 - share : 1.F, share > 0 && share < 1 ? share : 0.F, 0, 0});
  }

  SkinnedMesh mesh;
};

/// A place along a chain of joints: `bone` counts from the chain's first joint.
struct Section {
  size_t bone = 0;
  double along = 0;  ///< 0 at the joint where the bone begins, 1 at its end
  double width = 0, depth = 0;
};

/// A limb: one tube along `chain`, whose rings near a joint are shared with the bone before it.
/// `before` moves what lies before the first joint.
std::vector<Ring> limb_rings(const std::vector<Vec3>& points, const std::vector<int>& chain,
                             int before, const std::vector<Section>& sections) {
  std::vector<Ring> rings;
  for (const Section& section : sections) {
    const Vec3 &from = points[section.bone], &to = points[section.bone + 1];
    const Vec3 along = (to - from).normalized();
    const Vec3 reference = std::abs(along.z()) > 0.9 ? Vec3::UnitY() : Vec3::UnitZ();
    const Vec3 right = reference.cross(along).normalized();
    const Vec3 up = along.cross(right);
    // Half of a joint's ring belongs to either bone; a sixth of the bone later it is one bone's.
    constexpr double kBlend = 0.16;
    Hold hold{chain[section.bone], chain[section.bone], 0};
    if (section.along < kBlend) {
      const int previous = section.bone > 0 ? chain[section.bone - 1] : before;
      hold = {previous, chain[section.bone], std::max(0.0, 0.5 + 0.5 * section.along / kBlend)};
    } else if (section.along > 1 - kBlend && section.bone + 1 < chain.size()) {
      hold = {chain[section.bone], chain[section.bone + 1],
              std::max(0.0, 0.5 - 0.5 * (1 - section.along) / kBlend)};
    }
    rings.push_back(
        {from + section.along * (to - from), section.width * right, section.depth * up, hold});
  }
  return rings;
}

void sculpt_leg(Sculptor& sculptor, const std::vector<Vec3>& rest, bool left, double size) {
  const int hip = left ? kBodyLeftHip : kBodyRightHip, knee = left ? kBodyLeftKnee : kBodyRightKnee;
  const int ankle = left ? kBodyLeftAnkle : kBodyRightAnkle;
  const double s = size;
  sculptor.tube(Surface::body,
                limb_rings({rest[hip], rest[knee], rest[ankle]}, {hip, knee, ankle}, kBodyPelvis,
                           {{0, -0.02, 0.05 * s, 0.05 * s},
                            {0, 0.08, 0.083 * s, 0.085 * s},
                            {0, 0.3, 0.08 * s, 0.082 * s},
                            {0, 0.84, 0.058 * s, 0.06 * s},
                            {0, 1, 0.054 * s, 0.056 * s},
                            {1, 0.16, 0.05 * s, 0.056 * s},
                            {1, 0.32, 0.05 * s, 0.06 * s},
                            {1, 0.84, 0.034 * s, 0.036 * s},
                            {1, 1, 0.032 * s, 0.036 * s},
                            {1, 1.04, 0.02 * s, 0.024 * s}}));
}

/// A shoe from heel to tip, flat on the floor at height `sole`.
void sculpt_foot(Sculptor& sculptor, const std::vector<Vec3>& rest, bool left, double sole,
                 double size) {
  const int ankle = left ? kBodyLeftAnkle : kBodyRightAnkle,
            toe = left ? kBodyLeftToe : kBodyRightToe;
  Vec3 front = rest[toe] - rest[ankle];
  front.y() = 0;
  front = front.norm() > 1e-6 ? Vec3(front.normalized()) : Vec3::UnitZ();
  const Vec3 side = Vec3::UnitY().cross(front);
  const Vec3 heel(rest[ankle].x(), sole, rest[ankle].z());
  const double ball = std::max(0.05 * size, (rest[toe] - rest[ankle]).dot(front));
  const double instep = std::max(0.07 * size, rest[ankle].y() - sole + 0.02 * size);
  const auto ring = [&](double along, double height, double half_width, const Hold& hold) {
    // Up x side points to the front as a tube's rings must.
    return Ring{heel + along * front + Vec3(0, height / 2, 0), half_width * side,
                Vec3(0, height / 2, 0), hold};
  };
  const Hold foot{ankle, ankle, 0}, both{ankle, toe, 0.5}, toes{toe, toe, 0};
  std::vector<Ring> rings = {ring(-0.062 * size, 0.035 * size, 0.022 * size, foot),
                             ring(-0.05 * size, 0.065 * size, 0.034 * size, foot),
                             ring(0, instep, 0.04 * size, foot),
                             ring(0.5 * ball, 0.75 * instep, 0.042 * size, foot),
                             ring(ball, 0.05 * size, 0.05 * size, both),
                             ring(ball + 0.045 * size, 0.036 * size, 0.042 * size, toes),
                             ring(ball + 0.07 * size, 0.022 * size, 0.024 * size, toes)};
  sculptor.tube(Surface::accent, rings);
}

void sculpt_arm(Sculptor& sculptor, const std::vector<Vec3>& rest, bool left, double size) {
  const int collar = left ? kBodyLeftCollar : kBodyRightCollar;
  const int shoulder = left ? kBodyLeftShoulder : kBodyRightShoulder;
  const int elbow = left ? kBodyLeftElbow : kBodyRightElbow,
            wrist = left ? kBodyLeftWrist : kBodyRightWrist;
  const double s = size;
  const Vec3 outward = (rest[wrist] - rest[elbow]).normalized();
  const Vec3 tip = rest[wrist] + outward * 0.18 * s;
  sculptor.tube(Surface::body, limb_rings({rest[shoulder], rest[elbow], rest[wrist]},
                                          {shoulder, elbow, wrist}, collar,
                                          {{0, -0.22, 0.03 * s, 0.03 * s},
                                           {0, -0.1, 0.052 * s, 0.052 * s},
                                           {0, 0.06, 0.054 * s, 0.054 * s},
                                           {0, 0.3, 0.046 * s, 0.046 * s},
                                           {0, 0.84, 0.038 * s, 0.038 * s},
                                           {0, 1, 0.036 * s, 0.036 * s},
                                           {1, 0.16, 0.037 * s, 0.037 * s},
                                           {1, 0.35, 0.036 * s, 0.036 * s},
                                           {1, 0.84, 0.027 * s, 0.027 * s},
                                           {1, 1, 0.024 * s, 0.026 * s}}));
  // Palms face down in the T-pose, so a hand is flat in height and the thumb points to the front.
  sculptor.tube(Surface::accent, limb_rings({rest[wrist], tip}, {wrist}, elbow,
                                            {{0, -0.04, 0.016 * s, 0.02 * s},
                                             {0, 0.2, 0.019 * s, 0.036 * s},
                                             {0, 0.5, 0.018 * s, 0.042 * s},
                                             {0, 0.85, 0.014 * s, 0.034 * s},
                                             {0, 1, 0.008 * s, 0.018 * s}}));
  const Vec3 root = rest[wrist] + outward * 0.035 * s + Vec3(0, 0, 0.02 * s);
  const Vec3 thumb = root + outward * 0.045 * s + Vec3(0, 0, 0.05 * s);
  sculptor.tube(Surface::accent, limb_rings({root, thumb}, {wrist}, wrist,
                                            {{0, 0, 0.013 * s, 0.015 * s},
                                             {0, 0.6, 0.012 * s, 0.013 * s},
                                             {0, 1, 0.007 * s, 0.008 * s}}));
}

void sculpt_torso(Sculptor& sculptor, const std::vector<Vec3>& rest, double size) {
  const auto ring = [&](const Vec3& centre, double half_width, double half_depth, Hold hold) {
    return Ring{centre, Vec3(0, 0, half_depth * size), Vec3(half_width * size, 0, 0), hold};
  };
  const auto between = [&](int a, int b, double t) {
    return Vec3(rest[a] + t * (rest[b] - rest[a]));
  };
  const double shoulders =
      std::abs(rest[kBodyLeftShoulder].x() - rest[kBodyRightShoulder].x()) / size;
  const double hips = std::abs(rest[kBodyLeftHip].x() - rest[kBodyRightHip].x()) / size;
  const double pelvis_width = 0.095 + hips / 2, chest_width = std::max(0.13, shoulders * 0.45);
  const Vec3 crotch(rest[kBodyPelvis].x(),
                    std::min(rest[kBodyLeftHip].y(), rest[kBodyRightHip].y()),
                    rest[kBodyPelvis].z());
  sculptor.tube(
      Surface::body,
      {ring(crotch - Vec3(0, 0.085 * size, 0), 0.05, 0.05, {kBodyPelvis, kBodyPelvis, 0}),
       ring(crotch - Vec3(0, 0.05 * size, 0), pelvis_width * 0.75, 0.09,
            {kBodyPelvis, kBodyPelvis, 0}),
       ring(crotch, pelvis_width, 0.108, {kBodyPelvis, kBodyPelvis, 0}),
       ring(between(kBodyPelvis, kBodySpine1, 0.3), pelvis_width * 0.95, 0.105,
            {kBodyPelvis, kBodySpine1, 0.15}),
       ring(rest[kBodySpine1], 0.128, 0.095, {kBodyPelvis, kBodySpine1, 0.5}),
       ring(between(kBodySpine1, kBodySpine2, 0.5), 0.125, 0.092, {kBodySpine1, kBodySpine1, 0}),
       ring(rest[kBodySpine2], 0.13, 0.1, {kBodySpine1, kBodySpine2, 0.5}),
       ring(rest[kBodySpine3], 0.145, 0.112, {kBodySpine2, kBodySpine3, 0.6}),
       ring(between(kBodySpine3, kBodyNeck, 0.4), chest_width, 0.116,
            {kBodySpine3, kBodySpine3, 0}),
       ring(between(kBodySpine3, kBodyNeck, 0.7), chest_width * 0.92, 0.098,
            {kBodySpine3, kBodySpine3, 0}),
       ring(between(kBodySpine3, kBodyNeck, 0.92), chest_width * 0.55, 0.07,
            {kBodySpine3, kBodySpine3, 0}),
       ring(rest[kBodyNeck], 0.05, 0.05, {kBodySpine3, kBodyNeck, 0.4})});
}

void sculpt_head(Sculptor& sculptor, const std::vector<Vec3>& rest, double size) {
  sculptor.tube(Surface::body,
                limb_rings({rest[kBodyNeck], rest[kBodyHead]}, {kBodyNeck, kBodyHead}, kBodySpine3,
                           {{0, -0.3, 0.05 * size, 0.05 * size},
                            {0, 0.3, 0.047 * size, 0.05 * size},
                            {0, 1, 0.046 * size, 0.05 * size},
                            {0, 1.3, 0.04 * size, 0.045 * size}}));
  const Vec3 centre = rest[kBodyHead] + Vec3(0, 0.078, 0.012) * size;
  const auto axis = [&](double x, double y, double z) { return Vec3(Vec3(x, y, z) * size); };
  sculptor.ellipsoid(Surface::body, centre, axis(0.078, 0, 0), axis(0, 0.118, 0), axis(0, 0, 0.098),
                     kBodyHead);
  // A nose and eyes, so that it shows where the figure looks.
  sculptor.ellipsoid(Surface::accent, centre + axis(0, -0.012, 0.097), axis(0.013, 0, 0),
                     axis(0, 0.028, 0.006), axis(0, 0, 0.022), kBodyHead);
  for (const double side : {-1.0, 1.0}) {
    sculptor.ellipsoid(Surface::accent, centre + axis(side * 0.032, 0.02, 0.087), axis(0.013, 0, 0),
                       axis(0, 0.013, 0), axis(0, 0, 0.01), kBodyHead);
  }
}

}  // namespace

SkinnedMesh make_mannequin(const std::vector<Vec3>& rest) {
  const double leg = (rest[kBodyLeftHip] - rest[kBodyLeftKnee]).norm() +
                     (rest[kBodyLeftKnee] - rest[kBodyLeftAnkle]).norm();
  constexpr double kLegOfTheDesign = 0.82;  // metres, for the radii above
  const double size = leg / kLegOfTheDesign;
  const double sole = std::min(rest[kBodyLeftToe].y(), rest[kBodyRightToe].y());
  Sculptor sculptor;
  sculpt_torso(sculptor, rest, size);
  sculpt_head(sculptor, rest, size);
  for (const bool left : {true, false}) {
    sculpt_leg(sculptor, rest, left, size);
    sculpt_foot(sculptor, rest, left, sole, size);
    sculpt_arm(sculptor, rest, left, size);
  }
  return sculptor.finish();
}

}  // namespace remomask::rig
