/// Lines in the engine's log.
#pragma once

#include <haptics/binder/variant.hpp>

#include <source_location>

namespace haptics::godot {

/// An error with the place in our code; the editor shows it in its Debugger panel.
void print_error(const std::string& message, std::source_location where = std::source_location::current());
void print_warning(const std::string& message, std::source_location where = std::source_location::current());

namespace internal {
void print_array(const Variant* values, int64_t count);
} // namespace internal

/// What print() of a script does: the values joined, one line.
template <class... Args>
void print_line(const Args&... args) {
    const Variant values[sizeof...(Args) + 1] = {Variant(args)...};
    internal::print_array(values, static_cast<int64_t>(sizeof...(Args)));
}

#define ERR_PRINT(m_message) ::haptics::godot::print_error(m_message)
#define WARN_PRINT(m_message) ::haptics::godot::print_warning(m_message)

/// Prints and returns when the condition holds.
#define ERR_FAIL_COND_MSG(m_condition, m_message)                                                            \
    do {                                                                                                     \
        if (m_condition) [[unlikely]] {                                                                      \
            ::haptics::godot::print_error(m_message);                                                        \
            return;                                                                                          \
        }                                                                                                    \
    } while (false)
#define ERR_FAIL_COND_V_MSG(m_condition, m_result, m_message)                                                \
    do {                                                                                                     \
        if (m_condition) [[unlikely]] {                                                                      \
            ::haptics::godot::print_error(m_message);                                                        \
            return m_result;                                                                                 \
        }                                                                                                    \
    } while (false)

} // namespace haptics::godot
