// Loads an SDFormat world by sdformat's parser, pushes one sole in Gazebo's physics (DART), lets go; prints at each step
// where ankle and sole are: x y z and a quaternion x y z w.
//   push FILE PLUGIN STEP SETTLE FREE ANKLE SOLE torque|force X Y Z
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <ignition/physics/FindFeatures.hh>
#include <ignition/physics/ForwardStep.hh>
#include <ignition/physics/FrameSemantics.hh>
#include <ignition/physics/GetEntities.hh>
#include <ignition/physics/Link.hh>
#include <ignition/physics/RequestEngine.hh>
#include <ignition/physics/sdf/ConstructModel.hh>
#include <ignition/physics/sdf/ConstructWorld.hh>
#include <ignition/plugin/Loader.hh>
#include <sdf/Model.hh>
#include <sdf/Root.hh>
#include <sdf/World.hh>
namespace ip = ignition::physics;
struct Features : ip::FeatureList<ip::GetEngineInfo, ip::ForwardStep, ip::LinkFrameSemantics, ip::AddLinkExternalForceTorque,
                                  ip::sdf::ConstructSdfWorld, ip::GetModelFromWorld, ip::GetLinkFromModel> {};
int main(int argc, char **argv) {
  if (argc != 12) return 2;
  sdf::Root root;
  const auto errors = root.Load(argv[1]);
  for (const auto &error : errors) std::cerr << error.Message() << "\n";
  if (!errors.empty() || root.WorldCount() != 1) return 1;
  ignition::plugin::Loader loader;
  loader.LoadLib(argv[2]);
  auto engine = ip::RequestEngine3d<Features>::From(loader.Instantiate("ignition::physics::dartsim::Plugin"));
  if (!engine) { std::cerr << "no engine\n"; return 1; }
  auto world = engine->ConstructWorld(*root.WorldByIndex(0));
  auto model = world->GetModel(0);
  auto ankle = model->GetLink(std::string(argv[6])), sole = model->GetLink(std::string(argv[7]));
  if (!ankle || !sole) { std::cerr << "no such link\n"; return 1; }
  const bool force = std::string(argv[8]) == "force";
  const Eigen::Vector3d push(std::atof(argv[9]), std::atof(argv[10]), std::atof(argv[11]));
  const int settle = std::atoi(argv[4]), total = settle + std::atoi(argv[5]);
  ip::ForwardStep::Input input;
  ip::ForwardStep::State state;
  ip::ForwardStep::Output output;
  input.Get<std::chrono::steady_clock::duration>() =
      std::chrono::nanoseconds(static_cast<long>(1e9 * std::atof(argv[3])));
  auto show = [&] {
    for (const auto &link : {ankle, sole}) {
      const Eigen::Isometry3d pose = link->FrameDataRelativeToWorld().pose;
      const Eigen::Quaterniond turn(pose.linear());
      std::printf("%.17g %.17g %.17g %.17g %.17g %.17g %.17g ", pose.translation().x(), pose.translation().y(),
                  pose.translation().z(), turn.x(), turn.y(), turn.z(), turn.w());
    }
    std::printf("\n");
  };
  show();
  for (int count = 0; count < total; ++count) {
    if (count < settle) {
      if (force) sole->AddExternalForce(push); else sole->AddExternalTorque(push);
    }
    world->Step(output, state, input);
    if (count >= settle - 1) show();
  }
}
