// Bush deflection, its rate, and where the sole is, from encoders and IMU: of one foot for samples [begin, end), or of
// some feet at one tick.
#pragma once

#include "chain.hpp"
#include "pack.hpp"
#include "vec3.hpp"

namespace plantar::PLANTAR_ISA {

struct ImuState {
  Mat3 axes;  // in the world
  Vec3 gyroscope;
};

PLANTAR_INLINE ImuState imu_state(const Attitude& attitude, std::size_t first, std::size_t last) {
  const Lanes w = gather(attitude.quaternion[0], first, last), x = gather(attitude.quaternion[1], first, last);
  const Lanes y = gather(attitude.quaternion[2], first, last), z = gather(attitude.quaternion[3], first, last);
  const Lanes scale = 2.0 / (w * w + x * x + y * y + z * z);
  return {{{1.0 - scale * (y * y + z * z), scale * (x * y + w * z), scale * (x * z - w * y)},
           {scale * (x * y - w * z), 1.0 - scale * (x * x + z * z), scale * (y * z + w * x)},
           {scale * (x * z + w * y), scale * (y * z - w * x), 1.0 - scale * (x * x + y * y)}},
          {gather(attitude.angular_velocity[0], first, last), gather(attitude.angular_velocity[1], first, last),
           gather(attitude.angular_velocity[2], first, last)}};
}

// Where the path has come to and how fast its joints turn that, all in IMU axes.
struct PathState {
  Mat3 rotation;
  Vec3 origin, joints;

  template <class Numbers>
  PLANTAR_INLINE void enter(Numbers frame_rotation, Numbers frame_origin) {
    origin = origin + times(rotation, frame_origin);
    rotation = times_matrix(rotation, frame_rotation);
  }
  PLANTAR_INLINE void slide(Lanes q) { origin = origin + q * rotation.z; }
  PLANTAR_INLINE void turn(Lanes q, Lanes rate) {
    Lanes s, c;
    sincos(q, s, c);
    const Vec3 turned = c * rotation.x + s * rotation.y;
    rotation.y = c * rotation.y - s * rotation.x;
    rotation.x = turned;
    joints = joints + rate * rotation.z;
  }
};

PLANTAR_INLINE PathState at_imu() {
  const Lanes one = splat(1.0), zero = Lanes{};
  return {{{one, zero, zero}, {zero, one, zero}, {zero, zero, one}}, {zero, zero, zero}, {zero, zero, zero}};
}

// A flat sole on level ground: the world's up in the bush frame is all that the two angles need.
struct Level {
  Vec3 imu_up, up;
  Lanes square, length;

  // What a change of `up` is of pitch and roll.
  PLANTAR_INLINE Lanes pitch_change(Vec3 of_up) const { return (up.z * of_up.x - up.x * of_up.z) / square; }
  PLANTAR_INLINE Lanes roll_change(Vec3 of_up) const { return -of_up.y / length; }
};

PLANTAR_INLINE Level level_at(const PathState& bush, const ImuState& imu) {
  const Vec3 imu_up = {imu.axes.x.z, imu.axes.y.z, imu.axes.z.z}, up = transposed(bush.rotation, imu_up);
  const Lanes square = up.x * up.x + up.z * up.z;
  return {imu_up, up, square, sqrt(square)};
}

// Rows UP to ENCODER_RATE + 1. put: takes a row's number and its lanes.
template <class Numbers, class Put>
PLANTAR_INLINE void put_deflection(const PathState& bush, const ImuState& imu, const Level& level, Numbers sole_rotation,
                                   Numbers sole_origin, Put put) {
  const Vec3& up = level.up;
  put(UP, up.x), put(UP + 1, up.y), put(UP + 2, up.z);
  put(DEFLECTION, atan2(up.x, up.z)), put(DEFLECTION + 1, -atan2(up.y, level.length));
  const Vec3 turns = cross(up, transposed(bush.rotation, imu.gyroscope + bush.joints));
  put(RATE, level.pitch_change(turns)), put(RATE + 1, level.roll_change(turns));
  const Vec3 by_joints = cross(up, transposed(bush.rotation, bush.joints));
  put(ENCODER_RATE, level.pitch_change(by_joints)), put(ENCODER_RATE + 1, level.roll_change(by_joints));

  // The deflected sole: Ry(pitch) Rx(roll) about the bush centre, its sines and cosines straight from `up`.
  const Lanes cp = up.z / level.length, sp = up.x / level.length, cr = level.length, sr = -up.y;
  const Mat3 deflected = {{cp, Lanes{}, -sp}, {sp * sr, cr, cp * sr}, {sp * cr, -sr, cp * cr}};
  const Mat3 sole = bush.rotation * deflected;
  const Vec3 position = imu.axes * (bush.origin + times(sole, sole_origin));
  const Vec3 heading =
      imu.axes * (sole_rotation[0] * sole.x + sole_rotation[3] * sole.y + sole_rotation[6] * sole.z);
  put(SOLE_POSITION, position.x), put(SOLE_POSITION + 1, position.y), put(SOLE_POSITION + 2, position.z);
  put(HEADING, atan2(heading.y, heading.x));
}

PLANTAR_INLINE void chain_pack(const Chain& chain, const Attitude& attitude, std::size_t first, std::size_t last,
                               double* const* out) {
  const ImuState imu = imu_state(attitude, first, last);
  PathState path = at_imu();
  for (std::size_t i = 0; i < chain.n_steps; ++i) {
    const ChainStep& step = chain.steps[i];
    path.enter(step.frame.rotation, step.frame.origin);
    const Lanes q = step.sign * gather(step.position, first, last);
    if (step.slides)
      path.slide(q);
    else
      path.turn(q, step.sign * gather(step.velocity, first, last));
  }
  path.enter(chain.bush.rotation, chain.bush.origin);
  const Level level = level_at(path, imu);
  const auto put = [&](int row, Lanes x) { scatter(out[row] + first, x, last - first); };
  put_deflection(path, imu, level, chain.sole.rotation, chain.sole.origin, put);
  const Lanes one = splat(1.0), zero = Lanes{};
  const Vec3 axes[3] = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 of_up = transposed(path.rotation, cross(level.imu_up, axes[axis]));
    put(IMU_TURN + axis, level.pitch_change(of_up)), put(IMU_TURN + 3 + axis, level.roll_change(of_up));
  }
}

inline void chain(const Chain& chain, const Attitude& attitude, std::size_t begin, std::size_t end,
                  double* const* out) {
  for (std::size_t first = begin; first < end; first += LANES) chain_pack(chain, attitude, first, end, out);
}

// out: (IMU_TURN, LANES), all rows but those of the IMU's turn.
inline void chain_bundle(const Bundle& bundle, const Attitude& attitude, double* out) {
  const ImuState imu = imu_state(attitude, 0, LANES);
  PathState path = at_imu();
  LaneRows row = {bundle.rows};
  for (std::size_t i = 0; i < bundle.n_steps; ++i, row = row + STEP_ROWS) {
    path.enter(row + STEP_ROTATION, row + STEP_ORIGIN);
    path.slide(row[SLIDES] * row[POSITION]);
    path.turn(row[TURNS] * row[POSITION], row[TURNS] * row[VELOCITY]);
  }
  path.enter(row + BUSH_ROTATION, row + BUSH_ORIGIN);
  const auto put = [&](int number, Lanes x) { store(out + number * LANES, x); };
  put_deflection(path, imu, level_at(path, imu), row + SOLE_ROTATION, row + SOLE_ORIGIN, put);
}

}  // namespace plantar::PLANTAR_ISA
