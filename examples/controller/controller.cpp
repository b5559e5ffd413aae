// What a controller does with its feet: construct once, step every tick, use what may be trusted.
#include <cstdio>
#include <plantar/foot_estimator.hpp>
#include <vector>

int main(int, char** words) {
  const plantar::EstimatorModel model = plantar::load_model(words[1]);  // written by plantar online --write-model
  plantar::FootEstimator estimator(model);

  // A robot that stands still, with some noise: readings that repeat themselves would count as frozen. A controller
  // fills these from its sensors.
  const std::vector<double> position(model.joints.size(), 0.0);
  std::vector<std::array<double, 6>> wrench(model.feet.size());
  for (int tick = 0; tick < 2000; ++tick) {
    const double noise = 1e-6 * (tick % 7), load = model.weight / static_cast<double>(model.feet.size());
    for (auto& one : wrench) one = {noise, 0.0, load, 0.0, noise, 0.0};
    const double attitude[4] = {1.0, noise, 0.0, 0.0}, angular_velocity[3] = {noise, 0.0, 0.0};
    const auto feet = estimator.step({1e-3 * tick, position, {}, attitude, angular_velocity, {}, wrench});
    if (tick % 1000 < 999) continue;
    for (std::size_t f = 0; f < feet.size(); ++f)
      std::printf("%s: contact %d, load %.1f N, pitch %.4f rad, stiffness %s\n", model.feet[f].name.c_str(),
                  static_cast<int>(feet[f].contact), feet[f].load, feet[f].pitch.deflection,
                  feet[f].pitch.identified ? "known" : "not known yet");
  }
}
