// A model's text: every value has its place, and nothing is passed over.
#include <array>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "check.hpp"
#include "plantar/estimator_model.hpp"

namespace estimator_model_test {

using namespace plantar;

const std::string TURN = " 1 2 3 4 5 6 7 8 9 ";
const std::string ROBOT =
    "plantar.foot_estimator/1\nrobot biped\nweight 500\ncutoff 4\nwrench_delay 0.003 0.001\nwrench_gain_std 0.02\n"
    "joint knee\njoint hip\n";
const std::string FOOT = "foot left\ncontact always\npath 1 1 -1" + TURN + "0.1 0.2 0.3\nbends 2e-4\nbush" + TURN +
                         "0.4 0.5 0.6\nsole" + TURN + "0.7 0.8 0.9\nsensor -1" + TURN +
                         "1.1 1.2 1.3\ncorner 0.1 0.05\nplace_std 0.003 0.004\nmisplaced 1 0.01 0.02 0.03 0.04\n"
                         "unsure 1 0.03 0.04\ncompliance 1e-5 2e-6\nlinear 1\nelement 0 0.01 4 0.5\n";

EstimatorModel read(const std::string& text) {
  std::istringstream stream(text);
  return read_model(stream);
}

void every_value_has_its_place() {
  const EstimatorModel model = read(ROBOT + FOOT);
  check::that(model.robot == "biped" && model.joints == std::vector<std::string>{"knee", "hip"}, "names");
  check::that(model.weight == 500.0 && model.cutoff == 4.0, "the robot's numbers");
  check::that(model.wrench_delay == 0.003 && model.wrench_delay_std == 0.001, "a delay, and its deviation");
  check::that(model.wrench_gain_std == 0.02 && model.feet.size() == 1, "a gain's deviation; one foot");
  const FootModel& foot = model.feet[0];
  check::that(foot.name == "left" && foot.always, "its name, and that it always stands");
  const PathJoint& joint = foot.path.at(0);
  check::that(joint.joint == 1 && joint.slides && joint.sign == -1.0 && foot.sign == -1.0, "a joint; the sensor's sign");
  check::that(foot.bush.rotation[1] == 2.0 && foot.bush.rotation[8] == 9.0, "a turn row by row");
  check::that(foot.bush.origin[2] == 0.6 && foot.sole.origin[0] == 0.7 && foot.sensor.origin[1] == 1.2, "places");
  check::that(foot.polygon.size() == 1 && foot.polygon[0][0] == 0.1 && foot.polygon[0][1] == 0.05, "a corner");
  check::that(foot.place_std[0] == 0.003 && foot.place_std[1] == 0.004, "what the place may be off by");
  const Misplaced& roll = foot.misplaced[1];
  check::that(roll.aside == 0.01 && roll.above == 0.02 && roll.turned == 0.03 && roll.leans == 0.04, "what it is off by");
  check::that(foot.misplaced[0].aside == 0.0, "in roll alone");
  check::that(joint.compliance == 2e-4 && foot.unsure[1] == std::array{0.03, 0.04}, "a joint that bends");
  check::that(foot.unsure[0] == std::array{0.0, 0.0}, "in roll alone");
  check::that(foot.compliance == 1e-5 && foot.compliance_std == 2e-6, "a slide");
  check::that(!foot.linear[0] && foot.linear[1], "no memory in roll");
  check::that(foot.slip_angle[0] == 0.01 && foot.slip_torque[0] == 4.0 && foot.slip_torque_std[0] == 0.5, "an element");
  check::that(foot.slip_angle[1] == 0.0, "in pitch alone");
}

void what_is_not_known_is_refused() {
  const auto refused = [](const std::string& text) {
    try {
      read(text);
    } catch (const std::runtime_error&) {
      return true;
    }
    return false;
  };
  check::that(!refused(ROBOT + "\n" + FOOT), "an empty line is none");
  check::that(refused(ROBOT + "speed\n" + FOOT) && refused(ROBOT + FOOT + "speed\n"), "a word that nobody knows");
  check::that(refused(ROBOT + "weight 500 N\n" + FOOT), "a value too many");
  check::that(refused(ROBOT + "weight\n" + FOOT) && refused(ROBOT + "weight much\n" + FOOT), "none");
  check::that(refused(ROBOT + "foot left\nbends 1e-4\n" + FOOT), "a joint that bends before there is one");
  check::that(refused(ROBOT + FOOT + "linear 2\n") && refused(ROBOT), "no axis; no foot");
  check::that(refused("plantar.foot_estimator/2\nweight 500\n" + FOOT), "another version");
}

void run() {
  every_value_has_its_place();
  what_is_not_known_is_refused();
}

const check::Listed listed(run);

}  // namespace estimator_model_test
