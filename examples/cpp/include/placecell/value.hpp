// Value: one tree for requests, answers and headers, with readers and writers of JSON and msgpack.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace placecell {

// Error: bytes that are not what they should be, such as a broken answer or map file.
struct FormatError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Blob of msgpack: bytes that are not text.
struct Blob {
  std::string bytes;
};

class Value;
using List = std::vector<Value>;
using Member = std::pair<std::string, Value>;
using Object = std::vector<Member>;  // in the order of the file

class Value {
 public:
  Value() = default;  // null
  Value(bool flag) : content_(flag) {}
  Value(double number) : content_(number) {}
  Value(std::int64_t number) : content_(number) {}
  Value(int number) : content_(std::int64_t{number}) {}
  Value(std::string text) : content_(std::move(text)) {}
  Value(const char* text) : content_(std::string(text)) {}
  Value(Blob blob) : content_(std::move(blob)) {}
  Value(List list) : content_(std::move(list)) {}
  Value(Object object) : content_(std::move(object)) {}
  Value(const std::array<double, 3>& numbers) : Value(List(numbers.begin(), numbers.end())) {}

  bool is_null() const { return std::holds_alternative<std::monostate>(content_); }
  bool is_integer() const { return std::holds_alternative<std::int64_t>(content_); }
  bool is_object() const { return std::holds_alternative<Object>(content_); }

  bool flag() const { return as<bool>("a truth value"); }
  std::int64_t integer() const { return as<std::int64_t>("an integer"); }
  const std::string& text() const { return as<std::string>("a text"); }
  const std::string& blob() const { return as<Blob>("a blob").bytes; }
  const List& list() const { return as<List>("a list"); }
  const Object& object() const { return as<Object>("an object"); }
  double number() const {
    return is_integer() ? static_cast<double>(integer()) : as<double>("a number");
  }

  // Return the member of an object; nullptr if the object lacks it.
  const Value* find(std::string_view key) const {
    for (const Member& member : object())
      if (member.first == key) return &member.second;
    return nullptr;
  }
  const Value& operator[](std::string_view key) const {
    if (const Value* found = find(key)) return *found;
    throw FormatError("The key '" + std::string(key) + "' is missing.");
  }

  const auto& content() const { return content_; }

 private:
  template <class T>
  const T& as(const char* expected) const {
    if (const T* value = std::get_if<T>(&content_)) return *value;
    throw FormatError("A value has the wrong type: expected " + std::string(expected) + ".");
  }

  std::variant<std::monostate, bool, std::int64_t, double, std::string, Blob, List, Object>
      content_;
};

namespace detail {

constexpr int deepest = 64;  // levels of lists and objects that the readers accept

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

class JsonReader {
 public:
  explicit JsonReader(std::string_view text) : text_(text) {}

  Value whole() {
    Value value = next(0);
    skip_space();
    if (at_ != text_.size()) fail("characters follow the value");
    return value;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw FormatError("Invalid JSON at byte " + std::to_string(at_) + ": " + why + ".");
  }
  void skip_space() {
    while (at_ < text_.size() && std::strchr(" \t\r\n", text_[at_]) && text_[at_]) ++at_;
  }
  bool take(char wanted) {
    if (at_ >= text_.size() || text_[at_] != wanted) return false;
    ++at_;
    return true;
  }
  bool take(std::string_view word) {
    if (text_.substr(at_, word.size()) != word) return false;
    at_ += word.size();
    return true;
  }

  Value next(int depth) {
    if (depth > deepest) fail("it is nested too deeply");
    skip_space();
    if (take('{')) return object(depth);
    if (take('[')) return list(depth);
    if (take('"')) return text();
    if (take(std::string_view("true"))) return true;
    if (take(std::string_view("false"))) return false;
    if (take(std::string_view("null"))) return {};
    return number();
  }
  Value object(int depth) {
    Object members;
    skip_space();
    if (take('}')) return members;
    do {
      skip_space();
      if (!take('"')) fail("expected a key");
      std::string key = text();
      skip_space();
      if (!take(':')) fail("expected ':'");
      members.emplace_back(std::move(key), next(depth + 1));
      skip_space();
    } while (take(','));
    if (!take('}')) fail("expected ',' or '}'");
    return members;
  }
  Value list(int depth) {
    List values;
    skip_space();
    if (take(']')) return values;
    do {
      values.push_back(next(depth + 1));
      skip_space();
    } while (take(','));
    if (!take(']')) fail("expected ',' or ']'");
    return values;
  }
  Value number() {
    const std::size_t end = text_.find_first_not_of("+-.0123456789eE", at_);
    const std::string_view digits = text_.substr(at_, end - at_);
    const char *first = digits.data(), *last = first + digits.size();
    std::int64_t integer = 0;
    const auto whole = std::from_chars(first, last, integer);
    if (whole.ec == std::errc() && whole.ptr == last) {
      at_ += digits.size();
      return integer;
    }
    double real = 0;
    if (auto done = std::from_chars(first, last, real); done.ec != std::errc() || done.ptr != last)
      fail("expected a value");
    at_ += digits.size();
    return real;
  }
  std::string text() {
    std::string result;
    while (at_ < text_.size()) {
      const char c = text_[at_++];
      if (c == '"') return result;
      if (c != '\\') {
        result += c;
        continue;
      }
      if (at_ >= text_.size()) break;
      const char escaped = text_[at_++];
      static constexpr std::string_view names = "\"\\/bfnrt", values = "\"\\/\b\f\n\r\t";
      if (const std::size_t index = names.find(escaped); index != names.npos)
        result += values[index];
      else if (escaped == 'u')
        append_utf8(result, code_point());
      else
        fail("unknown escape");
    }
    fail("a text has no end");
  }
  unsigned four_digits() {
    unsigned value = 0;
    const char* first = text_.data() + at_;
    if (text_.size() - at_ < 4 || std::from_chars(first, first + 4, value, 16).ptr != first + 4)
      fail("expected four hexadecimal digits");
    at_ += 4;
    return value;
  }
  unsigned code_point() {
    const unsigned high = four_digits();
    if (high < 0xd800 || high > 0xdbff || !take(std::string_view("\\u"))) return high;
    return 0x10000 + ((high - 0xd800) << 10) + (four_digits() - 0xdc00);
  }
  static void append_utf8(std::string& out, unsigned code) {
    const auto add = [&out](unsigned byte) { out += static_cast<char>(byte); };
    if (code < 0x80) return add(code);
    if (code < 0x800)
      add(0xc0 | code >> 6);
    else if (code < 0x10000)
      add(0xe0 | code >> 12), add(0x80 | (code >> 6 & 0x3f));
    else
      add(0xf0 | (code >> 18 & 7)), add(0x80 | (code >> 12 & 0x3f)), add(0x80 | (code >> 6 & 0x3f));
    add(0x80 | (code & 0x3f));
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

class MsgpackReader {
 public:
  explicit MsgpackReader(std::string_view data) : data_(data) {}

  Value whole() {
    Value value = next(0);
    if (at_ != data_.size()) throw FormatError("Invalid msgpack: bytes follow the value.");
    return value;
  }

 private:
  std::string_view take(std::size_t count) {
    if (count > data_.size() - at_) throw FormatError("Invalid msgpack: the data is cut.");
    at_ += count;
    return data_.substr(at_ - count, count);
  }
  std::uint64_t big_endian(std::size_t width) {
    std::uint64_t value = 0;
    for (const char byte : take(width)) value = value << 8 | static_cast<std::uint8_t>(byte);
    return value;
  }
  Value next(int depth) {
    if (depth > deepest) throw FormatError("Invalid msgpack: it is nested too deeply.");
    const unsigned type = static_cast<unsigned>(big_endian(1));
    if (type < 0x80) return std::int64_t{type};
    if (type >= 0xe0) return std::int64_t{static_cast<std::int8_t>(type)};
    if (type < 0x90) return object(type & 15, depth);
    if (type < 0xa0) return list(type & 15, depth);
    if (type < 0xc0) return std::string(take(type & 31));
    switch (type) {
      case 0xc0: return {};
      case 0xc2: return false;
      case 0xc3: return true;
      case 0xc4: case 0xc5: case 0xc6:
        return Blob{std::string(take(big_endian(1u << (type - 0xc4))))};
      case 0xca: return real<float>(static_cast<std::uint32_t>(big_endian(4)));
      case 0xcb: return real<double>(big_endian(8));
      case 0xcc: case 0xcd: case 0xce: case 0xcf:
        return static_cast<std::int64_t>(big_endian(1u << (type - 0xcc)));
      case 0xd0: return std::int64_t{static_cast<std::int8_t>(big_endian(1))};
      case 0xd1: return std::int64_t{static_cast<std::int16_t>(big_endian(2))};
      case 0xd2: return std::int64_t{static_cast<std::int32_t>(big_endian(4))};
      case 0xd3: return static_cast<std::int64_t>(big_endian(8));
      case 0xd9: case 0xda: case 0xdb: return std::string(take(big_endian(1u << (type - 0xd9))));
      case 0xdc: case 0xdd: return list(big_endian(2u << (type - 0xdc)), depth);
      case 0xde: case 0xdf: return object(big_endian(2u << (type - 0xde)), depth);
      default: throw FormatError("Invalid msgpack: type byte " + std::to_string(type) + ".");
    }
  }
  Value list(std::uint64_t count, int depth) {
    List values;  // grows item by item: a count may claim more than the data holds
    for (; count > 0; --count) values.push_back(next(depth + 1));
    return values;
  }
  Value object(std::uint64_t count, int depth) {
    Object members;
    for (; count > 0; --count) {
      std::string key = next(depth + 1).text();
      members.emplace_back(std::move(key), next(depth + 1));
    }
    return members;
  }
  template <class Real, class Bits>
  static Value real(Bits bits) {
    static_assert(sizeof(Real) == sizeof(Bits));
    Real number;
    std::memcpy(&number, &bits, sizeof number);
    return static_cast<double>(number);
  }

  std::string_view data_;
  std::size_t at_ = 0;
};

class MsgpackWriter {
 public:
  void write(const Value& value) {
    std::visit(
        Overloaded{[this](std::monostate) { byte(0xc0); },
                   [this](bool flag) { byte(flag ? 0xc3 : 0xc2); },
                   [this](std::int64_t number) { integer(number); },
                   [this](double number) {
                     std::uint64_t bits;
                     std::memcpy(&bits, &number, sizeof bits);
                     byte(0xcb), big_endian(bits, 8);
                   },
                   [this](const std::string& text) {
                     if (text.size() < 32)
                       byte(0xa0 + static_cast<unsigned>(text.size()));
                     else
                       length(text.size(), 0xd9, 0);
                     out += text;
                   },
                   [this](const Blob& blob) {
                     length(blob.bytes.size(), 0xc4, 0);
                     out += blob.bytes;
                   },
                   [this](const List& list) {
                     if (list.size() < 16)
                       byte(0x90 + static_cast<unsigned>(list.size()));
                     else
                       length(list.size(), 0xdc, 1);
                     for (const Value& each : list) write(each);
                   },
                   [this](const Object& object) {
                     if (object.size() < 16)
                       byte(0x80 + static_cast<unsigned>(object.size()));
                     else
                       length(object.size(), 0xde, 1);
                     for (const Member& member : object) write(member.first), write(member.second);
                   }},
        value.content());
  }

  std::string out;

 private:
  void byte(unsigned value) { out += static_cast<char>(value); }
  void big_endian(std::uint64_t value, int width) {
    for (int shift = 8 * (width - 1); shift >= 0; shift -= 8) byte(value >> shift & 0xff);
  }
  // Write a length in the shortest of the types that follow `first`: 1, 2 and 4 bytes wide.
  void length(std::size_t size, unsigned first, int narrowest) {
    const int power = size < 0x100 && narrowest == 0 ? 0 : size < 0x10000 ? 1 : 2;
    if (size > 0xffffffff) throw FormatError("A request is too large for msgpack.");
    byte(first + static_cast<unsigned>(power - narrowest)), big_endian(size, 1 << power);
  }
  void integer(std::int64_t number) {
    const auto bits = static_cast<std::uint64_t>(number);
    if (number >= -32 && number < 128) return byte(bits & 0xff);
    int power = 0;  // of the width in bytes
    if (number >= 0) {
      while (power < 3 && bits >> (8 << power)) ++power;
      byte(0xcc + static_cast<unsigned>(power));
    } else {
      while (power < 3 && number < -(std::int64_t{1} << ((8 << power) - 1))) ++power;
      byte(0xd0 + static_cast<unsigned>(power));
    }
    big_endian(bits, 1 << power);
  }
};

}  // namespace detail

inline Value from_json(std::string_view text) { return detail::JsonReader(text).whole(); }
inline Value from_msgpack(std::string_view data) { return detail::MsgpackReader(data).whole(); }
inline std::string to_msgpack(const Value& value) {
  detail::MsgpackWriter writer;
  writer.write(value);
  return std::move(writer.out);
}

// Read the numbers of a blob, which may stand at any address. Little-endian machines only.
template <class T>
std::vector<T> numbers(std::string_view bytes) {
  if (bytes.size() % sizeof(T))
    throw FormatError("A blob has a length that does not fit its type.");
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

}  // namespace placecell
