#pragma once
// What a step leaves in the patches, and what it tells of them: memory, counts and events.

#include <haptics/core/local_model/local_model.hpp>

#include <algorithm>
#include <array>

namespace haptics::local {

// What became of one patch.
struct Outcome {
    ContactState state{ContactState::none};
    double normal_force{0.0};
    double tangent_force{0.0};
    double slip_spring{0.0};
    // of this step's collisions, N s
    double impulse{0.0};
    bool collided{false};
};

// Takes the patches in their order. They come sorted by body, and mostly the tool touches what it touched a
// step ago: then the list of bodies grows as the last one did, and nothing has to be looked for.
class Outcomes {
  public:
    Outcomes(Data& data, StepOutput& output)
        : data_(data)
        , output_(output) {}

    void tell(Patch& p, const Outcome& now) {
        const ContactState before = p.memory.state;
        const bool touches = now.state != ContactState::none;
        p.memory.state = now.state;
        p.memory.slip_spring = touches ? now.slip_spring : 0.0;
        p.memory.age = touches ? p.memory.age + 1 : 0;
        p.memory.normal_force = now.normal_force;
        p.memory.tangent_force = now.tangent_force;
        output_.contacts += touches ? 1 : 0;
        output_.colliding += now.state == ContactState::colliding ? 1 : 0;
        output_.sticking += now.state == ContactState::sticking ? 1 : 0;
        output_.sliding += now.state == ContactState::sliding ? 1 : 0;
        output_.impulse_size += now.impulse;
        if (!touches || p.body_a >= data_.tool.body_count)
            return;
        const std::uint64_t id = p.side.id_b;
        if (!goes_on(id))
            add_event(ContactEventKind::began, id, &p, 0.0);
        if (now.collided)
            add_event(ContactEventKind::impact, id, &p, now.impulse);
        if (before == ContactState::sticking && now.state == ContactState::sliding)
            add_event(ContactEventKind::slip, id, &p, 0.0);
    }

    // after the last patch
    void end() {
        if (same_ && count_ == data_.touched_count)
            return;
        for (std::int32_t i = 0; i < data_.touched_count; ++i) {
            const std::uint64_t id = data_.touched[static_cast<std::size_t>(i)];
            if (!contains(touched_, count_, id))
                add_event(ContactEventKind::ended, id, nullptr, 0.0);
        }
        std::copy_n(touched_.begin(), count_, data_.touched.begin());
        data_.touched_count = count_;
    }

  private:
    using Ids = std::array<std::uint64_t, k_max_patches>;
    static bool contains(const Ids& ids, std::int32_t count, std::uint64_t id) {
        return std::find(ids.begin(), ids.begin() + count, id) != ids.begin() + count;
    }

    // lists a body; whether the tool touched it a step ago
    bool goes_on(std::uint64_t id) {
        const auto next = static_cast<std::size_t>(count_);
        if (count_ > 0 && touched_[next - 1] == id)
            return contains(data_.touched, data_.touched_count, id);
        if (same_ && count_ < data_.touched_count && data_.touched[next] == id) {
            touched_[next] = id;
            ++count_;
            return true;
        }
        same_ = false;
        if (!contains(touched_, count_, id))
            touched_[static_cast<std::size_t>(count_++)] = id;
        return contains(data_.touched, data_.touched_count, id);
    }

    void add_event(ContactEventKind kind, std::uint64_t body, const Patch* patch, double impulse);

    Data& data_;
    StepOutput& output_;
    // as far as it goes, the list is that of the last step
    bool same_{true};
    std::int32_t count_{0};
    Ids touched_; // the first count_ are set
};

} // namespace haptics::local
