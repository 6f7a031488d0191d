#pragma once
/// Poses and velocities of links and of points on them. Links fixed to the ground (slot 0) stand still.

#include <haptics/core/dynamics/linkage_data.hpp>

namespace haptics {

/// Refreshes angle, rate, cosine and sine of every body: all that the chain kernels need.
void update_rotations(const LinkageModel& model, LinkageData& data);
/// Refreshes origins and their velocities. After update_rotations().
void update_positions(const LinkageModel& model, LinkageData& data);
/// Refreshes the accelerations at zero joint acceleration, for point_bias(). After update_positions().
void update_bias(const LinkageModel& model, LinkageData& data);
/// All three.
void update_kinematics(const LinkageModel& model, LinkageData& data);

/// Pose of the link's frame in the scene. After update_positions().
[[nodiscard]] Pose link_pose(const LinkageModel& model, const LinkageData& data, int link);
/// Pose of the link with its center of mass as the reference point. After update_positions().
[[nodiscard]] Pose link_center_pose(const LinkageModel& model, const LinkageData& data, int link);
/// Scene position (m) of the point `local` of the link's frame. After update_positions().
[[nodiscard]] Vec2 link_point(const LinkageModel& model, const LinkageData& data, int link,
                              const Vec2& local);
/// Velocity of the link's material point that is now at the scene position `point`. After update_positions().
[[nodiscard]] Twist point_velocity(const LinkageModel& model, const LinkageData& data, int link,
                                   const Vec2& point);
/// J' q' of that point: its acceleration at zero joint acceleration (m/s^2, m/s^2, rad/s^2). After
/// update_bias().
[[nodiscard]] Twist point_bias(const LinkageModel& model, const LinkageData& data, int link,
                               const Vec2& point);

} // namespace haptics
