#pragma once
/// Fixed-size array indexed by int, the type of every count and index in the dynamics.

#include <cstddef>

namespace haptics {

/// N values of type T; `operator[]` takes an int.
template <class T, int N>
struct Slots {
    /// The values.
    T item[static_cast<std::size_t>(N)]{};

    T& operator[](int index) { return item[index]; }
    const T& operator[](int index) const { return item[index]; }
    [[nodiscard]] T* data() { return item; }
    [[nodiscard]] const T* data() const { return item; }
    [[nodiscard]] T* begin() { return item; }
    [[nodiscard]] T* end() { return item + N; }
    [[nodiscard]] const T* begin() const { return item; }
    [[nodiscard]] const T* end() const { return item + N; }
};

} // namespace haptics
