// What the tool's push leaves in the movable neighbors: the counters of the report.
//
// The scene moves its bodies itself; the loop tells it what the tool adds. Told the tool's impulse alone, the
// scene would first let it move the body, and its own solver take it away again: an object of 0.3 g that the
// tool presses on a wall with 2 N would start with 110 m/s at every tick. What the wall and other objects
// answer to the push is known here already, so it belongs to what the scene is told.
//
// Only the answer to the push, though: the weight of a stack and its own collisions are the scene's. With T
// the tool's impulses on the movables, and f_j >= 0 those of the contacts among movables and with what
// stands behind them, the scene is told
//     P = T + sum_j lambda_j r_j,  0 <= lambda_j <= f_j,  r_j the contact's row,
// with the lambda that make P' M^-1 P least. So contacts take as much of the push as they bear, a free object
// is told all of it, what goes from one object to the next is told to both with opposite signs, and the
// energy of what is told is never above that of the push alone. Friction that sticks likewise between 0 and
// its impulse. Friction that slides, mu f, is there whether the tool pushes or not, so the scene takes it
// itself; of it the push causes no more than mu lambda (an object pushed along a floor is told all of the
// push, one that is pressed on a wall and drawn along it what the friction leaves).
// A link of a linkage that the loop itself steps (free_linkage.hpp) is told all that its contacts give it.
// Found coordinate by coordinate, starting from the best multiple of all f: that is the answer already where
// nothing but the push is borne, and every sweep lowers the energy further.

#include <algorithm>
#include <array>
#include <cmath>

#include "internal.hpp"

namespace haptics::local {
namespace {

constexpr int k_push_sweeps = 12;
// one row for each point and one for the friction of each patch
constexpr int k_most_answers = k_max_points + k_max_rows;

// friction this near to its bound slides
constexpr double k_sliding = 1.0 - 1e-6;

struct Answer {
    bool tangent;
    int index;
    double most;
    double share;
    double mobility;
    /// Of friction that slides: its coefficient, and how many of the answers before it are the normal ones of
    /// its patch.
    double friction;
    int normals;
};

class Push {
  public:
    Push(Data& data, const double* normal, const double* tangent)
        : data_(data)
        , s_(data.system)
        , normal_(normal)
        , tangent_(tangent)
        , push_(FreedomVector::Zero(s_.freedoms)) {
        const auto end = data.movable.begin() + data.movable_count;
        coupled_ = std::count_if(data.movable.begin(), end,
                                 [this](const MovableState& m) { return is_jointed(m); }) > 1;
    }

    // true when the tool pushes any of them
    bool collect() {
        bool pushed = false;
        for (int i = 0; i < s_.patches; ++i) {
            const PatchRow& t = s_.row[static_cast<std::size_t>(i)];
            if (t.patch < 0)
                continue;
            const Patch& p = data_.patches.patch[static_cast<std::size_t>(t.patch)];
            if (p.body_a >= data_.tool.body_count)
                add_answers(i, t);
            else if (t.movable >= 0 && data_.movable[static_cast<std::size_t>(t.movable)].row >= 0)
                pushed = add_push(i, t) || pushed;
        }
        return pushed;
    }

    void take_answers() {
        FreedomVector all = FreedomVector::Zero(s_.freedoms);
        for (int k = 0; k < count_; ++k)
            add(answer_[static_cast<std::size_t>(k)], answer_[static_cast<std::size_t>(k)].most, all);
        const double size = all.dot(inverse(all));
        if (!(size > 0.0))
            return;
        const FreedomVector alone = push_;
        const double part = std::clamp(-push_.dot(inverse(all)) / size, 0.0, 1.0);
        push_ += part * all;
        for (int k = 0; k < count_; ++k)
            answer_[static_cast<std::size_t>(k)].share = part * answer_[static_cast<std::size_t>(k)].most;
        for (int sweep = 0; sweep < k_push_sweeps; ++sweep)
            for (int k = 0; k < count_; ++k)
                relax(k);
        // the bounds of sliding friction move: no descent is sure
        if (push_.dot(inverse(push_)) > alone.dot(inverse(alone)))
            push_ = alone;
    }

    void tell_jointed() {
        bool any = false;
        for (int i = 0; i < data_.movable_count; ++i)
            any = any || is_jointed(data_.movable[static_cast<std::size_t>(i)]);
        if (!any)
            return;
        FreedomVector all = FreedomVector::Zero(s_.freedoms);
        for (int i = 0; i < s_.patches; ++i) {
            const PatchRow& t = s_.row[static_cast<std::size_t>(i)];
            all += tangent_[i] * s_.tangent_rows.row(i).transpose();
            for (int q = t.first_point; q < t.first_point + t.point_count; ++q)
                all += normal_[q] * s_.normal_rows.row(q).transpose();
        }
        for (int i = 0; i < data_.movable_count; ++i) {
            MovableState& m = data_.movable[static_cast<std::size_t>(i)];
            if (!is_jointed(m))
                continue;
            m.belief.given += all.segment<3>(m.row);
            m.given_step = data_.step;
        }
    }

    void tell() {
        for (int i = 0; i < data_.movable_count; ++i) {
            MovableState& m = data_.movable[static_cast<std::size_t>(i)];
            if (m.row < 0 || is_jointed(m))
                continue;
            m.belief.given += push_.segment<3>(m.row);
            m.given_step = data_.step;
        }
    }

  private:
    [[nodiscard]] bool is_jointed(const MovableState& m) const {
        return m.row >= 0 && m.body >= 0 && data_.neighbors.body[static_cast<std::size_t>(m.body)].jointed;
    }

    [[nodiscard]] FreedomVector inverse(const FreedomVector& impulse) const {
        FreedomVector v = impulse;
        const Eigen::Index n = s_.tool_freedoms;
        if (coupled_) { // links of one linkage
            const Eigen::Index others = v.size() - n;
            v.tail(others) =
                s_.inverse_mass.bottomRightCorner(others, others).lazyProduct(impulse.tail(others));
        } else {
            for (Eigen::Index i = n; i + 3 <= v.size(); i += 3)
                v.segment<3>(i) = s_.inverse_mass.block<3, 3>(i, i) * impulse.segment<3>(i);
        }
        v.head(s_.tool_freedoms).setZero();
        return v;
    }

    bool add_push(int i, const PatchRow& t) {
        const int row = data_.movable[static_cast<std::size_t>(t.movable)].row;
        bool any = tangent_[i] != 0.0;
        push_.segment<3>(row) += tangent_[i] * s_.tangent_rows.row(i).segment<3>(row).transpose();
        for (int q = t.first_point; q < t.first_point + t.point_count; ++q) {
            push_.segment<3>(row) += normal_[q] * s_.normal_rows.row(q).segment<3>(row).transpose();
            any = any || normal_[q] != 0.0;
        }
        return any;
    }

    void add_answers(int i, const PatchRow& t) {
        const int first = count_;
        double pressing = 0.0;
        for (int q = t.first_point; q < t.first_point + t.point_count; ++q)
            if (normal_[q] > 0.0) {
                pressing += normal_[q];
                add_answer({false, q, normal_[q], 0.0, 0.0, 0.0, 0});
            }
        if (tangent_[i] == 0.0)
            return;
        // in a collision the solver's bound tells
        const bool slides = t.mode == FrictionMode::slip_forward || t.mode == FrictionMode::slip_backward ||
                            std::abs(tangent_[i]) >= k_sliding * t.dynamic_friction * pressing;
        add_answer({true, i, tangent_[i], 0.0, 0.0, slides ? t.dynamic_friction : -1.0, count_ - first});
    }

    void add_answer(Answer a) {
        FreedomVector row = FreedomVector::Zero(s_.freedoms);
        add(a, 1.0, row);
        a.mobility = row.dot(inverse(row));
        if (a.mobility > 0.0 && count_ < k_most_answers)
            answer_[static_cast<std::size_t>(count_++)] = a;
    }

    void add(const Answer& a, double impulse, FreedomVector& to) const {
        if (a.tangent)
            to += impulse * s_.tangent_rows.row(a.index).transpose();
        else
            to += impulse * s_.normal_rows.row(a.index).transpose();
    }

    // the most that friction answers, with its sign
    [[nodiscard]] double most_of(int k) const {
        const Answer& a = answer_[static_cast<std::size_t>(k)];
        if (!a.tangent || a.friction < 0.0)
            return a.most;
        double pressing = 0.0;
        for (int n = k - a.normals; n < k; ++n)
            pressing += answer_[static_cast<std::size_t>(n)].share;
        return std::copysign(std::min(std::abs(a.most), a.friction * pressing), a.most);
    }

    void relax(int k) {
        Answer& a = answer_[static_cast<std::size_t>(k)];
        const double most = most_of(k);
        const FreedomVector v = inverse(push_);
        const double rate =
            a.tangent ? s_.tangent_rows.row(a.index).dot(v) : s_.normal_rows.row(a.index).dot(v);
        const double next = std::clamp(a.share - rate / a.mobility, std::min(most, 0.0), std::max(most, 0.0));
        add(a, next - a.share, push_);
        a.share = next;
    }

    Data& data_;
    ContactSystem& s_;
    const double* normal_;
    const double* tangent_;
    FreedomVector push_;
    bool coupled_{false};
    int count_{0};
    std::array<Answer, k_most_answers> answer_;
};

} // namespace

void tell_push(Data& data, const double* normal, const double* tangent) {
    if (data.system.freedoms == data.system.tool_freedoms)
        return;
    Push push(data, normal, tangent);
    push.tell_jointed();
    if (!push.collect())
        return;
    push.take_answers();
    push.tell();
}

} // namespace haptics::local
