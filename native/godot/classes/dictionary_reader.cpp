#include <haptics/classes/dictionary_reader.hpp>

#include <algorithm>
#include <cmath>

namespace haptics {

using namespace godot;

DictionaryReader::DictionaryReader(const Dictionary& from, std::string place, Problems& problems)
    : from_(from)
    , place_(std::move(place))
    , problems_(problems) {}

Variant DictionaryReader::take(const char* key, const std::vector<Variant::Type>& types, const char* wanted) {
    read_.insert(key);
    if (!from_.has(key))
        return {};
    Variant value = from_[key];
    if (std::find(types.begin(), types.end(), value.get_type()) != types.end())
        return value;
    problems_.add(place_ + key + " is " + Variant::get_type_name(value.get_type()).utf8() + ", must be " +
                  wanted + ".");
    return {};
}

double DictionaryReader::number(const char* key, double fallback) {
    const Variant v = take(key, {Variant::INT, Variant::FLOAT}, "a number");
    return v.get_type() == Variant::NIL ? fallback : v.to<double>();
}

int DictionaryReader::integer(const char* key, int fallback) {
    constexpr double k_most = 2e9;
    const double given = number(key, fallback);
    return std::isnan(given) ? 0 : static_cast<int>(std::clamp(given, -k_most, k_most));
}

bool DictionaryReader::flag(const char* key, bool fallback) {
    const Variant v = take(key, {Variant::BOOL}, "true or false");
    return v.get_type() == Variant::NIL ? fallback : v.to<bool>();
}

std::string DictionaryReader::text(const char* key, const std::string& fallback) {
    const Variant v = take(key, {Variant::STRING, Variant::STRING_NAME}, "text");
    return v.get_type() == Variant::NIL ? fallback : v.to<String>().utf8();
}

std::vector<double> DictionaryReader::numbers(const char* key) {
    const Variant v = take(key, {Variant::PACKED_FLOAT64_ARRAY, Variant::ARRAY}, "a list of numbers");
    std::vector<double> out;
    if (v.get_type() == Variant::PACKED_FLOAT64_ARRAY) {
        const auto packed = v.to<PackedFloat64Array>();
        out.assign(packed.span().begin(), packed.span().end());
    } else if (v.get_type() == Variant::ARRAY) {
        const Array list = v.to<Array>();
        for (int64_t i = 0; i < list.size(); ++i) {
            const Variant& entry = list[i];
            if (entry.get_type() != Variant::FLOAT && entry.get_type() != Variant::INT) {
                problems_.add(place_ + key + " holds something that is not a number at place " +
                              std::to_string(i) + ".");
                return {};
            }
            out.push_back(entry.to<double>());
        }
    }
    return out;
}

std::vector<double> DictionaryReader::numbers(const char* key, std::size_t count) {
    std::vector<double> out = numbers(key);
    if (from_.has(key) && out.size() != count) {
        problems_.add(place_ + key + " has " + std::to_string(out.size()) + " numbers, must have " +
                      std::to_string(count) + ".");
        return {};
    }
    return out;
}

Vec2 DictionaryReader::vec2(const char* key, const Vec2& fallback) {
    const std::vector<double> v = numbers(key, 2);
    return v.empty() ? fallback : Vec2(v[0], v[1]);
}

Vec3 DictionaryReader::vec3(const char* key, const Vec3& fallback) {
    const std::vector<double> v = numbers(key, 3);
    return v.empty() ? fallback : Vec3(v[0], v[1], v[2]);
}

Dictionary DictionaryReader::dictionary(const char* key) {
    const Variant v = take(key, {Variant::DICTIONARY}, "a Dictionary");
    return v.get_type() == Variant::NIL ? Dictionary() : v.to<Dictionary>();
}

Variant DictionaryReader::name_or_dictionary(const char* key) {
    return take(key, {Variant::STRING, Variant::STRING_NAME, Variant::DICTIONARY}, "a name or a Dictionary");
}

Array DictionaryReader::array(const char* key) {
    const Variant v = take(key, {Variant::ARRAY}, "an Array");
    return v.get_type() == Variant::NIL ? Array() : v.to<Array>();
}

void DictionaryReader::finish() {
    const Array keys = from_.keys();
    for (int64_t i = 0; i < keys.size(); ++i) {
        const std::string key = keys[i].stringify().utf8();
        if (read_.find(key) == read_.end())
            problems_.add(place_ + key + " is not known here. Remove it or correct its name.");
    }
}

} // namespace haptics
