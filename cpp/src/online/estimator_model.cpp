#include "plantar/estimator_model.hpp"

#include <fstream>
#include <locale>
#include <sstream>
#include <stdexcept>

namespace plantar {

namespace {

constexpr const char* FIRST_LINE = "plantar.foot_estimator/1";

// One line: a word that says what it is, then its values.
class Line {
 public:
  Line(const std::string& text, int number) : words_(text), number_(number) {
    words_.imbue(std::locale::classic());
    words_ >> kind_;
  }

  const std::string& kind() const { return kind_; }

  template <class Value>
  Value next() {
    Value value;
    if (!(words_ >> value)) fail("a value is missing or no number");
    return value;
  }

  Frame frame() {
    Frame frame;
    for (double& value : frame.rotation) value = next<double>();
    for (double& value : frame.origin) value = next<double>();
    return frame;
  }

  int axis() {
    const int axis = next<int>();
    if (axis != 0 && axis != 1) fail("no axis (valid: 0 for pitch, 1 for roll)");
    return axis;
  }

  bool ended() {
    words_ >> std::ws;
    return words_.eof();
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error("estimator model, line " + std::to_string(number_) + " ('" + kind_ + "'): " + what);
  }

 private:
  std::istringstream words_;
  std::string kind_;
  int number_;
};

void read_robot_line(EstimatorModel& model, Line& line) {
  if (line.kind() == "robot")
    model.robot = line.next<std::string>();
  else if (line.kind() == "weight")
    model.weight = line.next<double>();
  else if (line.kind() == "cutoff")
    model.cutoff = line.next<double>();
  else if (line.kind() == "wrench_delay")
    model.wrench_delay = line.next<double>(), model.wrench_delay_std = line.next<double>();
  else if (line.kind() == "wrench_gain_std")
    model.wrench_gain_std = line.next<double>();
  else if (line.kind() == "joint")
    model.joints.push_back(line.next<std::string>());
  else
    line.fail("unknown word");
}

void read_foot_line(FootModel& foot, Line& line) {
  if (line.kind() == "contact")
    foot.always = line.next<std::string>() == "always";
  else if (line.kind() == "path") {
    const int joint = line.next<int>();
    const bool slides = line.next<int>() != 0;
    const double sign = line.next<double>();
    foot.path.push_back({joint, slides, sign, line.frame()});
  } else if (line.kind() == "bends") {
    if (foot.path.empty()) line.fail("no joint is on the path yet");
    foot.path.back().compliance = line.next<double>();
  } else if (line.kind() == "bush")
    foot.bush = line.frame();
  else if (line.kind() == "sole")
    foot.sole = line.frame();
  else if (line.kind() == "sensor")
    foot.sign = line.next<double>(), foot.sensor = line.frame();
  else if (line.kind() == "corner") {
    const double x = line.next<double>(), y = line.next<double>();
    foot.polygon.push_back({x, y});
  } else if (line.kind() == "place_std")
    foot.place_std[0] = line.next<double>(), foot.place_std[1] = line.next<double>();
  else if (line.kind() == "misplaced") {
    Misplaced& to = foot.misplaced[line.axis()];
    to.aside = line.next<double>(), to.above = line.next<double>();
    to.turned = line.next<double>(), to.leans = line.next<double>();
  } else if (line.kind() == "unsure") {
    std::array<double, 2>& to = foot.unsure[line.axis()];
    to[0] = line.next<double>(), to[1] = line.next<double>();
  } else if (line.kind() == "compliance")
    foot.compliance = line.next<double>(), foot.compliance_std = line.next<double>();
  else if (line.kind() == "linear") {
    foot.linear[line.axis()] = true;
  } else if (line.kind() == "element") {
    const int axis = line.axis();
    foot.slip_angle[axis] = line.next<double>();
    foot.slip_torque[axis] = line.next<double>(), foot.slip_torque_std[axis] = line.next<double>();
  } else
    line.fail("unknown word");
}

}  // namespace

EstimatorModel read_model(std::istream& text) {
  EstimatorModel model;
  std::string content;
  for (int number = 1; std::getline(text, content); ++number) {
    if (content.empty()) continue;
    Line line(content, number);
    if (number == 1) {
      if (line.kind() != FIRST_LINE) line.fail(std::string("not a model of this version (valid: ") + FIRST_LINE + ")");
    } else if (line.kind() == "foot") {
      model.feet.emplace_back().name = line.next<std::string>();
    } else if (model.feet.empty()) {
      read_robot_line(model, line);
    } else {
      read_foot_line(model.feet.back(), line);
    }
    if (!line.ended()) line.fail("more values than expected");
  }
  if (model.feet.empty()) throw std::runtime_error("estimator model: no feet");
  return model;
}

EstimatorModel load_model(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("estimator model: cannot read " + path);
  return read_model(file);
}

}  // namespace plantar
