// Three rods that swing freely. The reference is the eighth-order method on native/core/dynamics, whose
// equations of motion are tested against Lagrange's by finite differences; the local model steps the same
// chain as a tool that nobody holds.

#include <haptics/core/dynamics/energy.hpp>
#include <haptics/core/dynamics/integrators/adams_bashforth4.hpp>
#include <haptics/core/dynamics/integrators/dormand_prince8.hpp>
#include <haptics/core/dynamics/integrators/linkage_motion.hpp>
#include <haptics/core/dynamics/integrators/runge_kutta4.hpp>
#include <haptics/core/dynamics/kinematics.hpp>
#include <haptics/core/geometry/shapes.hpp>
#include <haptics/core/local_model/local_model.hpp>
#include <haptics/sweep/experiment.hpp>

#include <cmath>
#include <stdexcept>

namespace haptics::sweep {

namespace {

constexpr int k_links = 3;
constexpr double k_length = 0.1;
constexpr double k_link_mass = 0.1;
constexpr double k_gravity = -9.81;

LinkageModel chain_model(bool gravity, bool coriolis) {
    LinkageSpec spec;
    spec.coriolis = coriolis;
    if (gravity)
        spec.gravity = Vec2(0.0, k_gravity);
    for (int i = 0; i < k_links; ++i) {
        LinkSpec link;
        link.parent = i - 1;
        link.mass = k_link_mass;
        link.inertia = k_link_mass * k_length * k_length / 12.0;
        link.center = {0.5 * k_length, 0.0};
        link.joint.frame = {i == 0 ? 0.0 : k_length, 0.0, 0.0};
        spec.links.push_back(link);
    }
    LinkageModel model;
    if (!build_model(spec, model).empty())
        throw std::logic_error("the chain of the sweep does not compile");
    return model;
}

// horizontal and bent a little, at rest
LinkageVector start_of_chain() {
    return Vec3(0.0, 0.3, -0.3);
}

/// Tip and energy from the coordinates alone.
class ChainProbe {
  public:
    Sample sample(const LinkageVector& position, const LinkageVector& velocity) {
        data_.position = position;
        data_.velocity = velocity;
        update_rotations(model_, data_);
        update_positions(model_, data_);
        Sample s;
        s.position = link_point(model_, data_, k_links - 1, Vec2(k_length, 0.0));
        s.energy = kinetic_energy(model_, data_) + potential_energy(model_, data_);
        return s;
    }

  private:
    LinkageModel model_{chain_model(true, true)};
    LinkageData data_{[this] {
        LinkageData d;
        reset(model_, d);
        return d;
    }()};
};

class LocalChainRun final : public Run {
  public:
    explicit LocalChainRun(const Setting& setting)
        : data_(std::make_unique<Data>())
        , step_(1.0 / setting.rate) {
        model_.tool.articulated = true;
        model_.tool.linkage = chain_model(false, setting.method != Method::paper);
        model_.tool.shape.body_count = k_links;
        for (std::size_t i = 0; i < k_links; ++i) {
            Body& body = model_.tool.shape.body[i];
            body.id = i;
            body.kind = BodyKind::tool;
            body.surface = neutral_surface();
        }
        model_.settings.strictly_semi_implicit = true; // the method itself is compared
        model_.settings.integrator = setting.scheme == Scheme::semi_implicit ? Integrator::semi_implicit
                                     : setting.scheme == Scheme::exact       ? Integrator::exact
                                                                             : Integrator::linearly_implicit;
        reset(model_, *data_, start_of_chain());
        Neighborhood scene;
        scene.sequence = 1;
        scene.gravity = Vec2(0.0, k_gravity);
        scene.plan = choose_plan(model_, scene);
        take_neighborhood(scene, *data_);
    }
    void step() override { haptics::step(model_, *data_, hand_, step_, out_); }
    Sample sample() override { return probe_.sample(data_->linkage.position, data_->linkage.velocity); }

  private:
    Model model_;
    std::unique_ptr<Data> data_;
    HandInput hand_;
    StepOutput out_;
    double step_;
    ChainProbe probe_;
};

template <class Method>
class SmoothChainRun final : public Run {
  public:
    explicit SmoothChainRun(double step)
        : step_(step) {
        reset(model_, data_);
        state_.setZero(2 * k_links);
        state_.head(k_links) = start_of_chain();
    }
    void step() override { method_.step(motion_, 0.0, step_, state_); }
    Sample sample() override { return probe_.sample(state_.head(k_links), state_.tail(k_links)); }

  private:
    LinkageModel model_{chain_model(true, true)};
    LinkageData data_;
    LinkageMotion motion_{model_, data_};
    Method method_;
    StateVector state_;
    double step_;
    ChainProbe probe_;
};

std::unique_ptr<Run> start_chain(const Setting& setting) {
    const double step = 1.0 / setting.rate;
    switch (setting.scheme) {
    case Scheme::adams_bashforth4:
        return std::make_unique<SmoothChainRun<AdamsBashforth4>>(step);
    case Scheme::runge_kutta4:
        return std::make_unique<SmoothChainRun<RungeKutta4>>(step);
    case Scheme::dormand_prince8:
        return std::make_unique<SmoothChainRun<DormandPrince8>>(step);
    case Scheme::semi_implicit:
    case Scheme::linearly_implicit:
    case Scheme::exact:
        break;
    }
    return std::make_unique<LocalChainRun>(setting);
}

} // namespace

Experiment swinging_chain() {
    Experiment e;
    e.name = "swinging_chain";
    e.title =
        "Three rods of 0.1 m and 0.1 kg swing under gravity, nobody holds them. The paper's preset drops the "
        "Coriolis terms; its error is against the true motion.";
    e.smooth = true;
    e.seconds = 1.0;
    e.schemes = {Scheme::semi_implicit,    Scheme::linearly_implicit, Scheme::exact,
                 Scheme::adams_bashforth4, Scheme::runge_kutta4,      Scheme::dormand_prince8};
    e.methods = {Method::penalty, Method::paper};
    e.start = start_chain;
    e.reference = [seconds = e.seconds](Method, int refinement) {
        const long steps = 4L << refinement;
        SmoothChainRun<DormandPrince8> run(k_sample_time / static_cast<double>(steps));
        Track track;
        const auto samples = std::lround(seconds / k_sample_time);
        for (long i = 0; i < samples; ++i) {
            for (long k = 0; k < steps; ++k)
                run.step();
            track.push_back(run.sample());
        }
        return track;
    };
    return e;
}

} // namespace haptics::sweep
