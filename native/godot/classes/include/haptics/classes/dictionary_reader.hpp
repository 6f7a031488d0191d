#pragma once
/// Reads settings out of a Dictionary and notes every key that is unknown, of the wrong type or without
/// sense.

#include <haptics/binder/godot.hpp>
#include <haptics/core/figure_error.hpp>
#include <haptics/core/types.hpp>

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace haptics {

/// Messages for an author. `prefix` names the place, e.g. "tool: ".
class Problems {
  public:
    void add(const std::string& message) { messages_.push_back(message); }
    void add(const std::vector<FigureError>& errors) {
        for (const FigureError& e : errors)
            messages_.push_back(e.message());
    }
    void add(const Problems& others) {
        messages_.insert(messages_.end(), others.messages_.begin(), others.messages_.end());
    }
    [[nodiscard]] bool none() const { return messages_.empty(); }
    [[nodiscard]] godot::PackedStringArray to_godot() const {
        godot::PackedStringArray out;
        for (const std::string& m : messages_)
            out.push_back(m);
        return out;
    }

  private:
    std::vector<std::string> messages_;
};

/// One Dictionary. Every read names its key; `finish` reports the keys that nobody read.
class DictionaryReader {
  public:
    DictionaryReader(const godot::Dictionary& from, std::string place, Problems& problems);

    /// A number (int or float); the fallback when the key is missing.
    double number(const char* key, double fallback);
    bool flag(const char* key, bool fallback);
    std::string text(const char* key, const std::string& fallback);
    /// Exactly `count` numbers, as PackedFloat64Array or Array; empty when missing.
    std::vector<double> numbers(const char* key, std::size_t count);
    /// Any count of numbers.
    std::vector<double> numbers(const char* key);
    Vec2 vec2(const char* key, const Vec2& fallback);
    Vec3 vec3(const char* key, const Vec3& fallback);
    /// One of the given names; the fallback when missing, a problem when none fits.
    template <class Enum>
    Enum choice(const char* key, Enum fallback, const std::vector<std::pair<const char*, Enum>>& names) {
        const std::string found = text(key, "");
        if (found.empty())
            return fallback;
        std::string known;
        for (const auto& [name, value] : names) {
            if (found == name)
                return value;
            known += (known.empty() ? "" : ", ") + std::string(name);
        }
        problems_.add(place_ + key + " is \"" + found + "\", must be one of: " + known + ".");
        return fallback;
    }
    /// A whole number, within 2e9 either way; what is no number is 0.
    int integer(const char* key, int fallback);
    /// A nested Dictionary; empty when missing.
    godot::Dictionary dictionary(const char* key);
    godot::Array array(const char* key);
    /// Text or a Dictionary; null when missing.
    godot::Variant name_or_dictionary(const char* key);
    [[nodiscard]] bool has(const char* key) const { return from_.has(key); }
    /// Reports unknown keys.
    void finish();
    [[nodiscard]] const std::string& place() const { return place_; }

  private:
    godot::Variant take(const char* key, const std::vector<godot::Variant::Type>& types, const char* wanted);

    const godot::Dictionary& from_;
    std::string place_;
    Problems& problems_;
    std::set<std::string> read_;
};

} // namespace haptics
