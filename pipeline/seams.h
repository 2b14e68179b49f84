#pragma once

#include <vector>

#include "db/database.h"
#include "remomask/motion.h"

namespace remomask::pipeline {

/// Jerk over time, m/s^3: entry t is the length of the third difference of frames
/// t .. t+3, mean over the joints. Frames - 3 entries; none for shorter motions.
std::vector<double> jerk_over_time(const Motion& motion, const Skeleton& skeleton);

/// Mean of the entries of such a curve whose four frames touch `reach` frames on
/// either side of the seam before frame `seam`; 0 where there is none.
double jerk_at_seam(const std::vector<double>& jerk, int seam, int reach = 5);

/// Mean jerk of at most `most` clips of the database, taken at equal distances
/// through its clips; 0 for a database without clips of the skeleton.
double jerk_of_database(const db::Database& database, const Skeleton& skeleton, int most = 200);

/// Height of the lowest foot joint of each frame, m.
std::vector<double> lowest_foot_over_time(const Motion& motion, const Skeleton& skeleton);

}  // namespace remomask::pipeline
