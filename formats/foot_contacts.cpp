#include "formats/foot_contacts.h"

#include <nlohmann/json.hpp>

#include "motion/features.h"
#include "remomask/skeleton.h"

namespace remomask::formats {

kinematics::FootContacts foot_contacts(const Motion& motion) {
  if (motion.frames < 2) {
    return kinematics::FootContacts(static_cast<size_t>(motion.frames), {false, false});
  }
  const Skeleton& skeleton = humanml_skeleton();
  return kinematics::read_contacts(
      motion::extract_features_all_frames(motion, skeleton, motion::FeatureMode::fixed), skeleton);
}

nlohmann::json foot_contacts_json(const Motion& motion) {
  const kinematics::FootContacts contacts = foot_contacts(motion);
  nlohmann::json result = {{"left", nlohmann::json::array()}, {"right", nlohmann::json::array()}};
  for (const size_t side : {0, 1}) {
    nlohmann::json& stretches = result[side == 0 ? "left" : "right"];
    for (size_t t = 0; t < contacts.size(); ++t) {
      if (!contacts[t][side]) continue;
      if (t == 0 || !contacts[t - 1][side]) stretches.push_back({t, t + 1});
      stretches.back()[1] = t + 1;
    }
  }
  return result;
}

}  // namespace remomask::formats
