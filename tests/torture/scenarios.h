#pragma once

#include <string>
#include <vector>

namespace remomask {

using Words = std::vector<std::string>;

/// A command that writes, and the files that it starts from. In its words, "@" stands for the
/// folder that it works in and "%" for a folder with what many commands need, which they only read:
/// d.sqlite with six clips, first.npy, files/ with all of them, and for those that generate
/// m.sqlite with its index and model.safetensors.
struct Scenario {
  const char* name;
  std::vector<Words> before;  ///< commands that make the files; {"cp", FROM, TO} copies one
  Words command;
  bool generates = false;  ///< needs the trained model
  /// Seconds by which the clock goes on at every look at it, so that what is written once a minute
  /// is written all the time.
  int clock_step = 0;
};

/// All commands that write.
const std::vector<Scenario>& scenarios();

/// The words with their folders.
Words in_folders(const Words& words, const std::string& folder, const std::string& shared);

}  // namespace remomask
