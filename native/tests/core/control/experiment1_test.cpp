// Where experiment 1 tells the two contact models apart, and where it does not.
// The test looks at the corners of the table in docs/experiment1.md (support/doc_table.hpp).

#include <haptics/shared/experiment1.hpp>

#include <doctest/doctest.h>

#include <iomanip>

#include "support/doc_table.hpp"

using namespace haptics;
using shared::Experiment1Options;

namespace {

using Outcome = shared::Experiment1Outcome;

Outcome run(ContactMode contact, double tool, double gain) {
    Experiment1Options o;
    o.contact = contact;
    o.tool_mass = tool;
    o.gain = gain;
    return shared::outcome_of(o);
}

void write_settling(std::ostream& out) {
    out << "| tool kg | coupling N/m | contact | settles s | swing N | swing of the handle µm | energy "
           "created mJ |\n"
           "|---|---|---|---|---|---|---|\n"
        << std::fixed;
    for (const double tool : {0.1, 0.3, 1.0})
        for (const double gain : {1.0 / 3.0, 2.0 / 3.0, 1.0, 1.5})
            for (const ContactMode contact : {ContactMode::penalty, ContactMode::penalty_impulse}) {
                const Outcome o = run(contact, tool, gain);
                out << "| " << std::setprecision(1) << tool << " | " << std::setprecision(0) << o.stiffness
                    << " | " << (contact == ContactMode::penalty ? "penalty" : "penalty and impulse")
                    << " | ";
                if (o.settling < 0.0)
                    out << "never";
                else
                    out << std::setprecision(2) << o.settling;
                out << " | " << std::setprecision(2) << o.force_swing << " | " << std::setprecision(0)
                    << o.handle_swing * 1e6 << " | " << std::setprecision(2) << o.energy * 1e3 << " |\n";
            }
}

} // namespace

TEST_CASE("experiment 1 tells the contact models apart for a heavy tool, and not for a soft coupling") {
    write_doc_table("experiment1_settling", write_settling);
    const Outcome penalty = run(ContactMode::penalty, 1.0, 1.0);
    const Outcome impulse = run(ContactMode::penalty_impulse, 1.0, 1.0);
    CHECK(penalty.settling < 0.0);
    CHECK(impulse.settling > 0.0);
    CHECK(impulse.force_swing < 0.1);
    CHECK(penalty.force_swing > 20.0 * impulse.force_swing);
    // a soft coupling settles either way, with the impulse sooner
    const Outcome soft_penalty = run(ContactMode::penalty, 0.3, 1.0 / 3.0);
    const Outcome soft_impulse = run(ContactMode::penalty_impulse, 0.3, 1.0 / 3.0);
    CHECK(soft_penalty.settling > 0.0);
    CHECK(soft_impulse.settling < soft_penalty.settling);
}
