// Accelerations are compared state by state. Motion is compared by where the tip ends after some steps of the
// same length: ours, MuJoCo and Pinocchio make the same semi-implicit step in the same coordinates and may
// differ by rounding alone. Box2D makes its semi-implicit step in the bodies' own coordinates, so that both
// meet only as the step goes to zero; what is left at the step of the run is in its demand.

#include <haptics/core/types.hpp>
#include <haptics/peers/agreement.hpp>

#include <cmath>
#include <random>

namespace haptics::peers {
namespace {

/// Random numbers that are the same on every machine.
class Draw {
  public:
    explicit Draw(std::uint64_t seed)
        : engine_(seed) {}
    void fill(std::vector<double>& values, double low, double high) {
        for (double& value : values)
            value = low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1p-53);
    }

  private:
    std::mt19937_64 engine_;
};

double largest(const std::vector<double>& values) {
    double found = 0.0;
    for (const double value : values)
        found = std::max(found, std::abs(value));
    return found;
}

/// The far end: where the joint of one more body like the last would be.
Vec2 tip(const ChainPlan& plan, const std::vector<double>& position) {
    Vec2 place{0.0, 0.0};
    double angle = 0.0;
    for (std::size_t i = 0; i < plan.size(); ++i) {
        place += Eigen::Rotation2Dd(angle) * Vec2(plan[i].joint_x, plan[i].joint_y);
        angle += plan[i].joint_angle + position[i];
    }
    return place + Eigen::Rotation2Dd(angle) * Vec2(2.0 * plan.back().center_x, 2.0 * plan.back().center_y);
}

double acceleration_difference(ChainPeer& peer, ChainPeer& own, std::size_t size, int states, Draw& draw) {
    std::vector<double> position(size);
    std::vector<double> velocity(size);
    std::vector<double> theirs(size);
    std::vector<double> ours(size);
    double worst = 0.0;
    for (int state = 0; state < states; ++state) {
        draw.fill(position, -3.0, 3.0);
        draw.fill(velocity, -3.0, 3.0);
        peer.set_state(position.data(), velocity.data());
        own.set_state(position.data(), velocity.data());
        peer.acceleration(theirs.data());
        own.acceleration(ours.data());
        const double size_of_it = largest(ours);
        for (std::size_t i = 0; i < size; ++i)
            theirs[i] -= ours[i];
        // written so that a NaN counts as the worst
        const double difference = largest(theirs) / size_of_it;
        if (!(difference <= worst))
            worst = difference;
    }
    return worst;
}

} // namespace

Agreement compare(ChainPeer& peer, const LinkageSpec& spec, const AgreementDemand& demand, int states,
                  std::uint64_t seed) {
    const ChainPlan plan = plan_of(spec);
    const std::size_t size = plan.size();
    const auto own = make_own_chain(spec);
    Draw draw(seed);
    Agreement result;
    bool holds = true;
    if (demand.acceleration >= 0.0) {
        result.acceleration = acceleration_difference(peer, *own, size, states, draw);
        holds = result.acceleration <= demand.acceleration;
    }
    // gently bent and turning one way, so that the run is a motion and not a rattle
    std::vector<double> position(size);
    std::vector<double> velocity(size);
    draw.fill(position, -0.5, 0.5);
    draw.fill(velocity, 0.0, 6.0 / static_cast<double>(size));
    peer.set_state(position.data(), velocity.data());
    own->set_state(position.data(), velocity.data());
    double path = 0.0;
    Vec2 place = tip(plan, position);
    for (int step = 0; step < demand.steps; ++step) {
        peer.step(demand.time_step);
        own->step(demand.time_step);
        own->get_state(position.data(), velocity.data());
        const Vec2 next = tip(plan, position);
        path += (next - place).norm();
        place = next;
    }
    peer.get_state(position.data(), velocity.data());
    result.motion = (tip(plan, position) - place).norm() / path;
    result.holds = holds && result.motion <= demand.motion;
    return result;
}

} // namespace haptics::peers
