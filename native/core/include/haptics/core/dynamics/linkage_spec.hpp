#pragma once
/// What an author says about a linkage: links, joints, base. Checked by validate(), compiled into a
/// LinkageModel.

#include <haptics/core/types.hpp>

#include <cstdint>
#include <limits>
#include <vector>

namespace haptics {

/// Most links of one linkage.
inline constexpr int k_max_links = 64;
/// Most freedoms of one linkage: a floating base has 3, every further link at most 1.
inline constexpr int k_max_freedoms = k_max_links + 2;

/// How a link moves against its parent.
enum class JointKind : std::uint8_t {
    revolute,  ///< turns about the joint frame's origin; the coordinate is an angle in rad
    prismatic, ///< slides along the joint frame's x axis; the coordinate is a distance in m
    fixed,     ///< does not move; the link is merged with its parent
};

/// What carries the first link.
enum class BaseKind : std::uint8_t {
    grounded, ///< links with parent -1 are jointed to the scene
    floating, ///< link 0 is free in the plane: 3 freedoms, the pose of its center of mass
};

/// A joint and its passive forces. Units are N m, rad for revolute joints and N, m for prismatic ones.
struct JointSpec {
    JointKind kind{JointKind::revolute};
    /// Joint frame in the parent link's frame (in the scene's when the parent is -1): m, m, rad.
    Pose frame{0.0, 0.0, 0.0};
    /// Range of the coordinate, lower < upper; infinite means no limit.
    double lower_limit{-std::numeric_limits<double>::infinity()};
    double upper_limit{std::numeric_limits<double>::infinity()};
    /// Spring and damper of the limits, >= 0: N m/rad or N/m; N m s/rad or N s/m.
    double limit_stiffness{0.0};
    double limit_damping{0.0};
    /// Viscous damping, >= 0: N m s/rad or N s/m.
    double damping{0.0};
    /// Coulomb friction, >= 0: N m or N.
    double friction{0.0};
    /// Speed below which the smooth friction model fades to zero, > 0: rad/s or m/s.
    double friction_band{1e-3};
    /// Joint spring, >= 0 (N m/rad or N/m), and its rest position (rad or m).
    double spring_stiffness{0.0};
    double spring_rest{0.0};
};

/// One link. Its frame sits at its joint: for coordinate 0 it coincides with the joint frame.
struct LinkSpec {
    /// Number of the parent link, smaller than this link's own; -1 is the scene (or nothing, for a floating
    /// base).
    int parent{-1};
    /// Mass in kg, > 0, and moment of inertia about the center of mass in kg m^2, > 0.
    double mass{0.0};
    double inertia{0.0};
    /// Center of mass in the link's frame, m.
    Vec2 center{0.0, 0.0};
    JointSpec joint;
};

/// A whole linkage. A rigid tool is a floating linkage of one link.
struct LinkageSpec {
    BaseKind base{BaseKind::grounded};
    std::vector<LinkSpec> links;
    /// Acceleration of gravity in the scene, m/s^2 (0 for a planar device that lies flat).
    Vec2 gravity{0.0, 0.0};
    /// False drops Coriolis and centrifugal terms: the paper's preset (eq. 1).
    bool coriolis{true};
};

} // namespace haptics
