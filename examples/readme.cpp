#include <remomask/remomask.h>

#include <cstdio>

int main() {
  const remomask::TextToMotion model(remomask::shipped_model(), remomask::shipped_database());
  const auto made = model.generate("a person walks forward, then waves with the right hand");
  for (const auto& found : made.evidence) {
    std::printf("%.2f %s\n", *found.hit.probability, found.hit.clip.name.c_str());
  }
  remomask::save_motion("wave.bvh", made);
}
