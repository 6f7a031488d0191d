#include <haptics/classes/haptic_world.hpp>
#include <haptics/core/local_model/validate.hpp>

#include <algorithm>
#include <cmath>

namespace haptics {

using namespace godot;

namespace {

std::string seconds_text(double s) {
    return std::to_string(s) + " s";
}

std::string state_text(std::span<const double> s) {
    const auto three = [s](std::size_t i) {
        return "(" + std::to_string(s[i]) + ", " + std::to_string(s[i + 1]) + ", " +
               std::to_string(s[i + 2]) + ")";
    };
    return "its pose is " + three(0) + " m, m, rad, its velocity " + three(3) +
           " m/s, m/s, rad/s and its free fall (" + std::to_string(s[6]) + ", " + std::to_string(s[7]) +
           ") m/s^2";
}

// why no force comes although nothing is wrong; empty when it comes, or a fault says it
std::string waits_for(const HapticReport& r) {
    if (r.armed || r.faults != Fault::none || r.step == 0)
        return "";
    return r.arm_wanted ? describe_arming(r.arming) : "Call arm().";
}

} // namespace

void HapticWorld::configure(const Dictionary& settings, Problems& problems) {
    if (running()) {
        problems.add("The world runs: stop it before its settings change.");
        return;
    }
    const WorldSettings read = read_world_settings(settings, problems);
    if (problems.none())
        settings_ = read;
}

void HapticWorld::set_tool(const Dictionary& tool, Problems& problems) {
    if (running()) {
        problems.add("The world runs: stop it before the tool changes.");
        return;
    }
    ToolModel t;
    if (tool.has("links")) {
        LinkageTool linkage = read_linkage_tool(tool, problems);
        if (!problems.none())
            return;
        tool_ = linkage.tool;
        tool_start_ = linkage.start;
        tool_rates_ = linkage.rates;
        return;
    }
    DictionaryReader r(tool, "tool.", problems);
    const BodySpec spec = read_body(r.dictionary("body"), "tool.", neutral_surface(), problems);
    const Vec2 grip = r.vec2("grip_point", Vec2::Zero());
    t.grip.point = grip - spec.center;
    t.grip.pose = r.flag("grip_pose", true);
    const Pose start = r.vec3("start", Vec3::Zero());
    const Twist rates = r.vec3("start_velocity", Vec3::Zero());
    r.finish();
    if (!rates.allFinite())
        problems.add("tool.start_velocity is (" + std::to_string(rates.x()) + ", " +
                     std::to_string(rates.y()) + ") m/s, " + std::to_string(rates.z()) +
                     " rad/s, which is not a number. Give it a real velocity.");
    constexpr double k_farthest = 1e5;
    if (!start.allFinite() || start.head<2>().cwiseAbs().maxCoeff() > k_farthest)
        problems.add("The tool stands at (" + std::to_string(start.x()) + ", " + std::to_string(start.y()) +
                     ") m, turned by " + std::to_string(start.z()) +
                     " rad, which is no place. Give it a real position and rotation.");
    // what follows from these would only repeat them
    if (!problems.none())
        return;
    t.mass = spec.body.mass;
    t.inertia = spec.body.inertia;
    if (spec.pieces.size() > static_cast<std::size_t>(k_max_pieces)) {
        problems.add("tool.shapes needs " + std::to_string(spec.pieces.size()) + " convex pieces, at most " +
                     std::to_string(k_max_pieces) + " fit. Draw it with fewer corners.");
        return;
    }
    t.shape.body_count = 1;
    t.shape.body[0] = spec.body;
    t.shape.body[0].id = 0;
    t.shape.body[0].kind = BodyKind::tool;
    t.shape.body[0].first_piece = 0;
    t.shape.body[0].piece_count = static_cast<std::int32_t>(spec.pieces.size());
    t.shape.piece_count = t.shape.body[0].piece_count;
    std::copy(spec.pieces.begin(), spec.pieces.end(), t.shape.piece.begin());
    Model model;
    model.tool = t;
    problems.add(validate(model));
    if (!problems.none())
        return;
    tool_ = t;
    tool_center_ = spec.center;
    tool_start_ = node_to_center(start, spec.center);
    tool_rates_ = rates;
}

void HapticWorld::set_device(const Dictionary& device, Problems& problems) {
    if (running()) {
        problems.add("The world runs: stop it before the device changes.");
        return;
    }
    const DeviceOptions read = read_device(device, problems);
    if (problems.none())
        device_options_ = read;
}

void HapticWorld::set_body(std::int64_t id, const Dictionary& body, Problems& problems) {
    BodySpec spec = read_body(body, "", Surface{}, problems);
    if (problems.none())
        bodies_.set(id, std::move(spec));
}

void HapticWorld::remove_body(std::int64_t id) {
    bodies_.remove(id);
    complained_.erase(id);
}

void HapticWorld::submit(std::span<const std::int64_t> ids, std::span<const double> states,
                         std::span<const ReachDisc> discs, std::span<const std::int64_t> masks,
                         const Tick& when, const Vec2& gravity, Problems& problems) {
    if (!running())
        return;
    const double tick = when.length;
    if (!std::isfinite(tick) || tick < 1e-3 || tick > 1.0) {
        problems.add("The tick is " + seconds_text(tick) +
                     ", must lie between 0.001 and 1 s. Set the physics ticks per second accordingly.");
        return;
    }
    if (!gravity.allFinite()) {
        problems.add("gravity is (" + std::to_string(gravity.x()) + ", " + std::to_string(gravity.y()) +
                     ") m/s^2, which is not a number; the scene is not felt. Give both figures, or set "
                     "gravity_source to NONE.");
        return;
    }
    Neighborhood& n = runner_->neighborhood();
    n.gravity = gravity;
    n.tool_ignores.fill(0);
    for (std::size_t i = 0; i < std::min(masks.size(), n.tool_ignores.size()); ++i)
        n.tool_ignores[i] = ~static_cast<std::uint32_t>(masks[i]);
    for (const std::size_t i : bodies_.build(ids, states, discs, n))
        if (!complained_[ids[i]]) {
            complained_[ids[i]] = true;
            problems.add("Body " + std::to_string(ids[i]) + " was left out: " +
                         (bodies_.find(ids[i]) == nullptr
                              ? "it is not registered. Describe it with world_set_body() first."
                              : state_text(states.subspan(i * BodyRegistry::k_state, BodyRegistry::k_state)) +
                                    ", which is not a number. Give it a real position and velocity."));
        }
    n.sequence = ++sequence_;
    const auto most = static_cast<int>(std::clamp<std::int64_t>(when.most, 1, 1000));
    // in lock-step a tick is told before its own time is run: alike for all, and when ticks change their
    // length the difference goes away slowly
    constexpr double k_forget = 2.0;
    tick_lead_ += last_tick_ > 0.0 ? tick - last_tick_ : 0.0;
    tick_lead_ *= std::max(1.0 - tick / k_forget, 0.0);
    last_tick_ = tick;
    n.time = realtime_ ? ticks_.tick(now(), tick, when.frame, most) : now() + tick_lead_;
    n.tick = tick;
    n.echo_step = echo_step_;
    n.echo = echo_;
    n.echo_count = echo_count_;
    // only the stages that the step needs with these bodies; the tool and the method never change while it
    // runs
    n.plan = settings_.whole_scene ? Plan() : choose_plan(runner_->session().model(), n);
    plan_ = n.plan;
    shown_.bodies.body_count = n.bodies.body_count;
    shown_.bodies.piece_count = n.bodies.piece_count;
    std::copy_n(n.bodies.body.begin(), n.bodies.body_count, shown_.bodies.body.begin());
    std::copy_n(n.bodies.piece.begin(), n.bodies.piece_count, shown_.bodies.piece.begin());
    shown_.overflow = n.overflow;
    runner_->publish();
    note_overflow(problems);
    ++ve_ticks_;
    for (const std::string& message : device_->take_messages())
        problems.add(message);
}

// everything but the thread
void HapticWorld::begin(bool realtime, double record_seconds, Problems& problems) {
    if (!tool_)
        problems.add("The world has no tool. Add a HapticTool2D with a collision shape.");
    if (!device_options_)
        problems.add("The world has no device. Set a HapticDevice resource.");
    if (!std::isfinite(record_seconds) || record_seconds < 0.0 || record_seconds > 3600.0)
        problems.add("record_seconds is " + seconds_text(record_seconds) +
                     ", must lie between 0 and 3600 s. 0 records nothing.");
    if (realtime && !is_valid_rate(settings_.loop.rate_hz))
        problems.add("The rate is " + std::to_string(settings_.loop.rate_hz) +
                     " Hz; in real time it must lie between 250 and 10000 Hz.");
    if (!problems.none())
        return;
    DeviceOptions device = *device_options_;
    // the thread that writes to a device is as urgent as the loop
    if (auto* hid = std::get_if<HidPantographOptions>(&device.device))
        hid->priority = std::clamp(settings_.loop.priority, 0, k_max_priority);
    device_ = WorldDevice::make(device, realtime, problems);
    if (device_ == nullptr)
        return;
    Model model;
    model.tool = *tool_;
    model.settings = settings_.model;
    SessionSettings session = settings_.session;
    session.device_delay = device_->delay();
    session.sample_period = device_->sample_period();
    session.reading_error = device_->reading_error();
    session.care = device_options_->care;
    session.care.compensation.delay = device_->latency(session.step);
    session.observer.delay = device_->latency(session.step);
    const double longest = HandleObserver::k_most_delay * session.step;
    if (session.observer.enabled && session.observer.delay > longest) {
        problems.add("The world's observer looks ahead by at most " + std::to_string(1e3 * longest) +
                     " ms at this rate, and the device is late by " +
                     std::to_string(1e3 * session.observer.delay) +
                     " ms. Lower the rate, use a device with less delay, or switch observer off.");
        device_.reset();
        return;
    }
    OutputGate gate(settings_.safety, device_->kinematics());
    problems.add(validate(session, model));
    if (!problems.none()) {
        device_.reset();
        return;
    }
    auto made = std::make_unique<Session>(session, model, gate, device_->port(), tool_start_);
    if (session.observer.enabled && made->observer() == nullptr) {
        problems.add("The world's observer finds no coupling that holds with a delay of " +
                     std::to_string(1e3 * session.observer.delay) + " ms and the device's mass wrong by " +
                     std::to_string(session.observer.mass_error) +
                     ". Lower observer_mass_error, use a device with less delay, or switch observer off.");
        made.reset();
        device_.reset();
        return;
    }
    made->set_rates(tool_rates_);
    gains_ = made->gains();
    report_ = made->report();
    runner_ = std::make_unique<HapticRunner>(std::move(made), device_->hook());
    runner_->record(record_seconds);
    realtime_ = realtime;
    sequence_ = 0;
    ve_ticks_ = 0;
    tick_time_.clear();
    ticks_.reset();
    echo_step_ = 0;
    echo_count_ = 0;
    taken_.clear();
    complained_.clear();
    shown_.bodies.body_count = 0;
    shown_.bodies.piece_count = 0;
    shown_.overflow = 0;
    overflowed_ticks_ = 0;
    said_full_ = false;
    said_movables_ = false;
    given_report_ = HapticReport{};
    last_tick_ = tick_lead_ = 0.0;
    scheduling_ = "lock-step";
    scheduling_details_ = "Lock-step: the haptic steps run on the main thread, at each physics tick.";
}

void HapticWorld::start(bool realtime, double record_seconds, Problems& problems) {
    if (running())
        return;
    begin(realtime, record_seconds, problems);
    if (!running() || !realtime)
        return;
    steal_.begin();
    LoopOptions options;
    options.rate_hz = settings_.loop.rate_hz;
    options.priority = settings_.loop.priority;
    options.cpu = settings_.loop.cpu;
    if (!runner_->start(options)) {
        problems.add(runner_->thread().report().failure);
        stop();
        return;
    }
    scheduling_ = runner_->thread().report().summary();
    scheduling_details_ = runner_->thread().report().describe();
}

void HapticWorld::stop() {
    while (!guests_.empty())
        guests_.back()->stop();
    if (host_ != nullptr) {
        host_->runner_->detach(*runner_);
        std::erase(host_->guests_, this);
        host_ = nullptr;
    }
    if (runner_ != nullptr) {
        runner_->stop();
        refresh();
        // a thread does that when it ends
        if (!realtime_)
            runner_->session().shut_off();
        last_force_ = device_->last_force();
    }
    runner_.reset();
    device_.reset();
}

int HapticWorld::advance(double seconds) {
    if (!running() || realtime_ || host_ != nullptr || !std::isfinite(seconds) || seconds <= 0.0)
        return 0;
    return runner_->advance(seconds);
}

void HapticWorld::refresh() {
    if (!running())
        return;
    report_ = runner_->latest_report();
    runner_->collect();
}

std::vector<GivenImpulse> HapticWorld::take_impulses() {
    // the bodies of the next snapshot reflect what was handed out at the last call
    echo_step_ = given_report_.step;
    echo_ = given_report_.movable;
    echo_count_ = given_report_.movable_count;
    given_report_ = report_;
    std::vector<GivenImpulse> out;
    for (std::int32_t i = 0; i < report_.movable_count; ++i) {
        const MovableBelief& m = report_.movable[static_cast<std::size_t>(i)];
        const auto id = static_cast<std::int64_t>(m.id);
        Taken& taken = taken_[id];
        // a link has it already
        const BodySpec* spec = bodies_.find(id);
        if (spec != nullptr && spec->body.jointed)
            continue;
        if (taken.epoch != m.epoch)
            taken = {m.epoch, Wrench::Zero()};
        const Wrench delta = m.given - taken.given;
        taken.given = m.given;
        if (!delta.isZero(0.0))
            out.push_back({id, delta});
    }
    return out;
}

Array HapticWorld::take_events() {
    Array out;
    if (!running())
        return out;
    runner_->drain_events([&out](const ContactEvent& e) {
        static constexpr std::array<const char*, 4> k_names{"began", "ended", "impact", "slip"};
        Dictionary d;
        d["kind"] = k_names[static_cast<std::size_t>(e.kind)];
        d["body"] = static_cast<int64_t>(e.body);
        d["time"] = e.time;
        d["position"] = PackedFloat64Array({e.position[0], e.position[1]});
        d["normal"] = PackedFloat64Array({e.normal[0], e.normal[1]});
        d["impulse"] = e.impulse;
        out.push_back(d);
    });
    return out;
}

void HapticWorld::book_tick(double seconds) {
    if (seconds >= 0.0 && seconds < 3600.0)
        tick_time_.add(static_cast<std::int64_t>(seconds * 1e9));
}

Dictionary HapticWorld::statistics() const {
    Dictionary d;
    if (!running())
        return d;
    const LoopStatistics s = runner_->statistics();
    d["mode"] = realtime_ ? "realtime" : "lockstep";
    d["haptic_rate_hz"] = settings_.loop.rate_hz;
    d["steps"] = static_cast<int64_t>(s.steps);
    d["missed_deadlines"] = static_cast<int64_t>(s.missed_deadlines);
    d["skipped_periods"] = static_cast<int64_t>(s.skipped_periods);
    d["ve_ticks"] = static_cast<int64_t>(ve_ticks_);
    Dictionary wake;
    wake["p50"] = static_cast<double>(s.wake_latency.p50_ns()) * 1e-3;
    wake["p99"] = static_cast<double>(s.wake_latency.percentile(0.99)) * 1e-3;
    wake["p999"] = static_cast<double>(s.wake_latency.percentile(0.999)) * 1e-3;
    wake["max"] = static_cast<double>(s.wake_latency.max_ns) * 1e-3;
    d["wake_latency_us"] = wake;
    Dictionary step;
    step["p50"] = s.step_time.p50_ns();
    step["p99"] = s.step_time.percentile(0.99);
    step["max"] = s.step_time.max_ns;
    step["mean"] = s.step_time.mean_ns();
    // of a lock-step's mean: what simulates the device
    step["simulation"] = device_->simulation_ns();
    d["step_ns"] = step;
    const HistogramSnapshot ticks = tick_time_.snapshot();
    Dictionary tick;
    tick["p50"] = static_cast<double>(ticks.p50_ns()) * 1e-3;
    tick["p99"] = static_cast<double>(ticks.p99_ns()) * 1e-3;
    tick["max"] = static_cast<double>(ticks.max_ns) * 1e-3;
    d["tick_us"] = tick;
    d["scheduling"] = String(scheduling_);
    d["scheduling_details"] = String(scheduling_details_);
    if (realtime_) {
        const auto stolen = steal_.fraction();
        d["host_steal"] = stolen ? Variant(*stolen) : Variant();
    }
    const RunFigures& run = report_.run;
    d["max_force_n"] = run.max_force;
    d["rms_position_error_m"] =
        run.error_count > 0 ? std::sqrt(run.error_sum / static_cast<double>(run.error_count)) : 0.0;
    d["max_penetration_m"] = run.max_penetration;
    d["energy_injected_j"] = report_.energy_injected;
    d["collisions"] = static_cast<int64_t>(run.collisions);
    d["fallbacks"] = static_cast<int64_t>(report_.fallbacks);
    d["exact_gave_way"] = static_cast<int64_t>(report_.exact_gave_way);
    d["patch_overflow"] = static_cast<int64_t>(report_.patch_overflow);
    d["movable_overflow"] = static_cast<int64_t>(report_.movable_overflow);
    d["neighborhood"] = neighborhood_figures();
    d["rows_dropped"] = static_cast<int64_t>(runner_->rows_dropped());
    d["events_dropped"] = static_cast<int64_t>(runner_->events_dropped());
    PackedStringArray faults;
    for (int bit = 0; bit < k_fault_count; ++bit)
        if ((static_cast<std::uint32_t>(report_.faults) >> bit) & 1U)
            faults.push_back(describe_fault(bit));
    d["faults"] = faults;
    d["force_waits_for"] = String(waits_for(report_));
    d["kernel"] = String(std::string(kernel_name(runner_->session().model())));
    d["plan"] = plan();
    d["coupling_stiffness_n_m"] = gains_.stiffness.x();
    d["coupling_damping_n_s_m"] = gains_.damping.x();
    d["coupling_stiffness_n_m_rad"] = gains_.stiffness.z();
    d["coupling_damping_n_m_s_rad"] = gains_.damping.z();
    const Dictionary device = device_->statistics();
    if (!device.is_empty())
        d["device"] = device;
    return d;
}

Array HapticWorld::plan() const {
    Array out;
    const auto add = [&out](std::string_view stage, bool runs, std::string_view reason) {
        Dictionary line;
        line["stage"] = String(std::string(stage));
        line["runs"] = runs;
        line["reason"] = String(std::string(reason));
        out.push_back(line);
    };
    for (const PlanLine& line : describe(plan_))
        add(line.stage, line.runs, line.reason);
    const bool records = runner_ != nullptr && runner_->recording();
    add("recorder", records, records ? "" : "nothing is recorded (record_seconds is 0)");
    return out;
}

void HapticWorld::aim(const Pose& grip) {
    if (device_ != nullptr && grip.allFinite())
        device_->aim(grip);
}

bool HapticWorld::send(RunnerCommand command) {
    return running() && runner_->try_send(command);
}

void HapticWorld::place(const HandPlacement& placement) {
    if (running())
        runner_->place(placement);
}

void HapticWorld::home_device(Problems& problems) {
    if (!running())
        problems.add("The world does not run, so its device cannot be homed. Start it first.");
    else
        device_->home(problems);
}

void HapticWorld::save_samples(const std::string& path, double interval, Problems& problems) {
    if (!running() || !runner_->recording()) {
        problems.add("There is no recording: start the world with a recording time.");
        return;
    }
    std::string error;
    if (!runner_->write_samples(path, interval, error))
        problems.add(error);
}

void HapticWorld::save_recording(const std::string& path, Problems& problems) {
    if (!running() || !runner_->recording()) {
        problems.add("There is no recording: start the world with a recording time.");
        return;
    }
    std::string error;
    if (!runner_->write_recording(path, error))
        problems.add(error);
}

} // namespace haptics
