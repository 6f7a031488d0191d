/// String and StringName.
#pragma once

#include <haptics/binder/builtin.hpp>

#include <string>
#include <string_view>

namespace haptics::godot {

class StringName;

/// The engine's text, shared and copied on write. Text enters and leaves as UTF-8.
class String : public internal::Builtin<GDEXTENSION_VARIANT_TYPE_STRING, 8> {
  public:
    String() = default;
    String(const char* utf8)
        : String(std::string_view(utf8)) {}
    String(const std::string& utf8)
        : String(std::string_view(utf8)) {}
    String(std::string_view utf8);
    explicit String(const StringName& name);

    /// A copy as UTF-8.
    std::string utf8() const;
    /// Number of characters (not bytes).
    int64_t length() const { return internal::call_int(ops().size, _native_ptr(), nullptr, 0); }
    bool is_empty() const { return length() == 0; }

    String& operator+=(const String& other);
    friend String operator+(String left, const String& right) {
        left += right;
        return left;
    }
};

/// An interned name: comparing two is comparing pointers.
class StringName : public internal::Builtin<GDEXTENSION_VARIANT_TYPE_STRING_NAME, 8> {
  public:
    StringName() = default;
    StringName(const char* utf8);
    StringName(const String& text);

    std::string utf8() const { return String(*this).utf8(); }
    bool is_empty() const { return String(*this).is_empty(); }
};

namespace internal {

/// A name made on first use and released when the library goes (a static with a destructor would outlive the
/// engine).
class StaticName {
  public:
    explicit StaticName(const char* text);
    const StringName& get() const { return *reinterpret_cast<const StringName*>(bytes_); }

    /// Destroys every name made so far; get() must not be called afterwards.
    static void release_all();

  private:
    alignas(8) std::byte bytes_[8] = {};
    StaticName* next_ = nullptr;
};

} // namespace internal

/// A StringName of a literal, made once: `emit_signal(SNAME("fault_raised"))`.
#define SNAME(m_text)                                                                                        \
    ([]() -> const ::haptics::godot::StringName& {                                                           \
        static const ::haptics::godot::internal::StaticName name(m_text);                                    \
        return name.get();                                                                                   \
    }())

} // namespace haptics::godot
