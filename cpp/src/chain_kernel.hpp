// Bush deflection, its rate, and where the sole is, from encoders and IMU, for samples [begin, end).
#pragma once

#include "chain.hpp"
#include "pack.hpp"
#include "vec3.hpp"

namespace plantar::PLANTAR_ISA {

PLANTAR_INLINE void chain_pack(const Chain& chain, const Attitude& attitude, std::size_t first, std::size_t last,
                               double* const* out) {
  Lanes w = gather(attitude.quaternion[0], first, last), x = gather(attitude.quaternion[1], first, last);
  Lanes y = gather(attitude.quaternion[2], first, last), z = gather(attitude.quaternion[3], first, last);
  const Lanes scale = 2.0 / (w * w + x * x + y * y + z * z);
  const Mat3 world = {  // IMU axes in the world
      {1.0 - scale * (y * y + z * z), scale * (x * y + w * z), scale * (x * z - w * y)},
      {scale * (x * y - w * z), 1.0 - scale * (x * x + z * z), scale * (y * z + w * x)},
      {scale * (x * z + w * y), scale * (y * z - w * x), 1.0 - scale * (x * x + y * y)}};
  const Vec3 gyroscope = {gather(attitude.angular_velocity[0], first, last),
                          gather(attitude.angular_velocity[1], first, last),
                          gather(attitude.angular_velocity[2], first, last)};

  // Along the path, everything is expressed in IMU axes.
  const Lanes one = splat(1.0), zero = Lanes{};
  Mat3 rotation = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
  Vec3 origin = {zero, zero, zero}, joints = {zero, zero, zero};
  for (std::size_t i = 0; i < chain.n_steps; ++i) {
    const ChainStep& step = chain.steps[i];
    origin = origin + times(rotation, step.frame.origin);
    rotation = times_matrix(rotation, step.frame.rotation);
    const Lanes q = step.sign * gather(step.position, first, last);
    if (step.slides) {
      origin = origin + q * rotation.z;
    } else {
      Lanes s, c;
      sincos(q, s, c);
      const Vec3 turned = c * rotation.x + s * rotation.y;
      rotation.y = c * rotation.y - s * rotation.x;
      rotation.x = turned;
      joints = joints + (step.sign * gather(step.velocity, first, last)) * rotation.z;
    }
  }
  origin = origin + times(rotation, chain.bush.origin);
  rotation = times_matrix(rotation, chain.bush.rotation);

  // A flat sole on level ground: the world's up in the bush frame is all that the two angles need.
  const Vec3 imu_up = {world.x.z, world.y.z, world.z.z}, up = transposed(rotation, imu_up);
  const Lanes level2 = up.x * up.x + up.z * up.z, level = sqrt(level2);
  const auto change = [&](double* pitch, double* roll, Vec3 of_up) {  // of the angles with a change of `up`
    scatter(pitch + first, (up.z * of_up.x - up.x * of_up.z) / level2, last - first);
    scatter(roll + first, -of_up.y / level, last - first);
  };
  scatter(out[UP] + first, up.x, last - first);
  scatter(out[UP + 1] + first, up.y, last - first);
  scatter(out[UP + 2] + first, up.z, last - first);
  scatter(out[DEFLECTION] + first, atan2(up.x, up.z), last - first);
  scatter(out[DEFLECTION + 1] + first, -atan2(up.y, level), last - first);
  change(out[RATE], out[RATE + 1], cross(up, transposed(rotation, gyroscope + joints)));
  change(out[ENCODER_RATE], out[ENCODER_RATE + 1], cross(up, transposed(rotation, joints)));
  const Vec3 axes[3] = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
  for (int axis = 0; axis < 3; ++axis)
    change(out[IMU_TURN + axis], out[IMU_TURN + 3 + axis], transposed(rotation, cross(imu_up, axes[axis])));

  // The deflected sole: Ry(pitch) Rx(roll) about the bush centre, its sines and cosines straight from `up`.
  const Lanes cp = up.z / level, sp = up.x / level, cr = level, sr = -up.y;
  const Mat3 deflected = {{cp, zero, -sp}, {sp * sr, cr, cp * sr}, {sp * cr, -sr, cp * cr}};
  const Mat3 sole = rotation * deflected;
  const Vec3 position = world * (origin + times(sole, chain.sole.origin));
  const double forward[3] = {chain.sole.rotation[0], chain.sole.rotation[3], chain.sole.rotation[6]};
  const Vec3 heading = world * times(sole, forward);
  scatter(out[SOLE_POSITION] + first, position.x, last - first);
  scatter(out[SOLE_POSITION + 1] + first, position.y, last - first);
  scatter(out[SOLE_POSITION + 2] + first, position.z, last - first);
  scatter(out[HEADING] + first, atan2(heading.y, heading.x), last - first);
}

inline void chain(const Chain& chain, const Attitude& attitude, std::size_t begin, std::size_t end,
                  double* const* out) {
  for (std::size_t first = begin; first < end; first += LANES) chain_pack(chain, attitude, first, end, out);
}

}  // namespace plantar::PLANTAR_ISA
