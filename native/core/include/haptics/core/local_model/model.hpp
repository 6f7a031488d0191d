#pragma once
/// Constants of the local model: the tool, the method, the limits. Built off the loop, never written while
/// stepping.

#include <haptics/core/contact/body.hpp>
#include <haptics/core/contact/collision.hpp>
#include <haptics/core/dynamics/linkage_model.hpp>

#include <cstdint>

namespace haptics {

/// How stiff contacts are integrated in time.
enum class Integrator : std::uint8_t {
    /// Forces at the start of the step, positions with the new velocity: cheapest; needs m > (K h^2 + 2 B h)
    /// / 4 per contact. A step whose contacts may be beyond that is linearly implicit, and
    /// StepOutput::fell_back says so.
    semi_implicit,
    /// Forces at the end of the step, linearized: stable for every stiffness and mass; damps fast contact
    /// modes.
    linearly_implicit,
    /// Springs, dampers and friction solved exactly from event to event (touch, release, stick, slip) within
    /// the step: a lossless bounce stays lossless, however stiff and wherever in the step it falls. Costs
    /// more. Where it does not apply (more than 24 freedoms, 32 points or 32 patches and joints; hundreds of
    /// oscillations in one step) the linearly implicit one does the rest of the step, and
    /// StepOutput::exact_gave_way says so.
    exact,
};

/// What happens when a contact closes.
enum class ContactMode : std::uint8_t {
    penalty_impulse, ///< collision impulse upon contact, spring-damper afterwards (the paper's model ii)
    penalty,         ///< spring-damper alone (the paper's model i)
};

/// Where and how the hand holds the tool.
struct Grip {
    /// Held link; 0 for a rigid tool.
    std::int32_t link{0};
    /// Held point in the axes of that link (from its center of mass), m.
    Vec2 point{0.0, 0.0};
    /// True: position and angle are held (3 rows). False: the point alone (2 rows), the tool turns freely
    /// about it.
    bool pose{true};
};

struct LocalModelSettings {
    Integrator integrator{Integrator::linearly_implicit};
    /// True: semi_implicit steps where it is unstable too. For comparisons of integrators.
    bool strictly_semi_implicit{false};
    ContactMode contact_mode{ContactMode::penalty_impulse};
    CollisionMethod collision_method{CollisionMethod::poisson};
    /// Approach slower than this gives no collision impulse, m/s, > 0.
    double collision_speed{0.005};
    /// Contacts are looked for within this distance beyond the reach of the step's motion, m.
    double margin{0.0005};
    /// Most collision events resolved at their own time within one step; later ones wait for the next step.
    int max_events{4};
    /// Linkages of more freedoms than this are solved row by row, in O(n), while their contacts are few.
    int dense_freedoms{8};
};

/// What the user holds: a rigid body in the axes of its center of mass, or a whole linkage.
struct ToolModel {
    /// The tool is `linkage`, held by one of its links; mass and inertia below are then not used.
    bool articulated{false};
    /// kg, > 0.
    double mass{0.1};
    /// Moment of inertia about the center of mass, kg m^2, > 0.
    double inertia{1e-5};
    /// Grip at the start; Data has the present one.
    Grip grip;
    /// Shapes and surfaces: body[i] with kind `tool` is link i, in the axes of the link turned as its frame,
    /// with the link's center of mass as the origin. A link without shape touches nothing.
    BodySet shape;
    /// Links, joints, masses (gravity comes with the neighborhood, not from here).
    LinkageModel linkage;

    /// Freedoms of the tool.
    [[nodiscard]] int freedoms() const { return articulated ? linkage.freedoms : 3; }
};

struct Model {
    ToolModel tool;
    LocalModelSettings settings;
};

} // namespace haptics
