#pragma once
/// What can be wrong with a LinkageSpec, with the value at fault and the remedy.

#include <haptics/core/dynamics/linkage_spec.hpp>

#include <string>
#include <vector>

namespace haptics {

/// Kinds of faults.
enum class LinkageError : std::uint8_t {
    no_links,                   ///< the linkage is empty
    too_many_links,             ///< more than k_max_links
    no_freedom,                 ///< every joint is fixed
    not_finite,                 ///< NaN or infinity where a number is needed
    mass_not_positive,          ///< mass <= 0
    inertia_not_positive,       ///< inertia <= 0
    parent_missing,             ///< the parent's number is no link
    cycle,                      ///< the chain of parents comes back to the link
    parent_after_child,         ///< the parent stands after its child
    second_root,                ///< a floating linkage with more than one link without parent
    limits_out_of_order,        ///< lower_limit >= upper_limit
    limit_stiffness_negative,   ///< limit_stiffness < 0
    limit_damping_negative,     ///< limit_damping < 0
    damping_negative,           ///< damping < 0
    friction_negative,          ///< friction < 0
    friction_band_not_positive, ///< friction_band <= 0 with friction
    spring_stiffness_negative,  ///< spring_stiffness < 0
    too_large, ///< a figure of a joint beyond 1e12: no joint has it, and a step loses its digits
};

/// One fault.
struct LinkageFault {
    LinkageError error{LinkageError::no_links};
    /// Link at fault, -1 for the linkage as a whole.
    int link{-1};
    /// The value at fault.
    double value{0.0};
    /// Name of the property at fault.
    const char* property{""};
};

/// Lists every fault of `spec`; empty means that build_model() succeeds. Allocates: not for the loop.
[[nodiscard]] std::vector<LinkageFault> validate(const LinkageSpec& spec);

/// One sentence: what failed, the value, the link, the remedy.
[[nodiscard]] std::string describe(const LinkageFault& fault);

} // namespace haptics
