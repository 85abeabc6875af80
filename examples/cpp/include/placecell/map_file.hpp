// Map files: docs/reference/map-file.md describes each byte.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "sha256.hpp"
#include "value.hpp"

namespace placecell {

// Segments of one coordinate frame with their stored descriptors. Row i of every column belongs to
// segment i; `codes` has `code_bytes` numbers a segment.
struct Map {
  std::string model_id, preprocessing, frame;
  std::vector<std::string> robots;   // names
  std::vector<std::string> sources;  // names of the maps that it was merged from

  std::vector<std::uint32_t> ids;
  std::vector<std::array<double, 3>> centroids;  // meters, in the map's frame
  std::vector<std::uint32_t> robot;              // index in `robots`
  std::vector<std::uint32_t> capture;            // index in `times`, `positions`, `orientations`
  std::size_t code_bytes = 0;
  std::vector<std::int8_t> codes;

  std::vector<double> times;                        // of the captures, seconds
  std::vector<std::array<double, 3>> positions;     // of the sensor, meters, in the map's frame
  std::vector<std::array<float, 4>> orientations;   // of the sensor: x, y, z, w; sensor to map

  // Optional columns; empty if the file lacks them.
  std::vector<std::array<std::uint8_t, 3>> extents;  // decimeters
  std::vector<std::uint16_t> points;
  std::vector<std::uint32_t> views, seen, source_ids;
  std::vector<std::uint8_t> classes;  // 0: unknown; else 1 + 31 * class + step of 30
  std::vector<std::uint16_t> source;  // from 1 in `sources`; 0: written to this map itself

  std::size_t size() const { return ids.size(); }
};

namespace detail {

inline std::size_t bytes_of_type(const std::string& type) {
  constexpr std::string_view names[] = {"F64", "F32", "U32", "U16", "I16", "U8", "I8"};
  constexpr std::size_t widths[] = {8, 4, 4, 2, 2, 1, 1};
  for (std::size_t i = 0; i < std::size(names); ++i)
    if (type == names[i]) return widths[i];
  throw FormatError("A column has the unknown type '" + type + "'.");
}

// One file: its headers, and its columns where they stand.
class MapFileReader {
 public:
  explicit MapFileReader(std::string_view data) : data_(data) {
    std::uint64_t length = 0;
    if (data.size() < 8)
      throw FormatError("It has only " + std::to_string(data.size()) + " bytes.");
    std::memcpy(&length, data.data(), 8);
    if (length > data.size() - 8)
      throw FormatError("Its header is longer than the file, so it is cut.");
    if (length > (1u << 20)) throw FormatError("Its header exceeds 1,048,576 bytes.");
    outer_ = from_json(data.substr(8, length));
    body_ = data.substr(8 + length);
    inner_text_ = outer_["__metadata__"]["placecell"].text();
    inner = from_json(inner_text_);
    if (inner["format"].text() != "placecell-map")
      throw FormatError("Its format is '" + inner["format"].text() +
                        "', expected 'placecell-map'.");
    if (inner["version"].integer() != 1)
      throw FormatError("It has version " + std::to_string(inner["version"].integer()) +
                        ", but this program reads version 1.");
    if (inner["scale_cm"].integer() != 1) throw FormatError("Its scale is not 1 cm.");
    check_columns();
    check_sum();
  }

  // Return the numbers of a column; a narrower unsigned type is widened.
  template <class T>
  std::vector<T> column(const std::string& name, std::size_t rows, std::size_t width,
                        std::initializer_list<const char*> types) const {
    const Value& entry = outer_[name];
    const std::string& type = entry["dtype"].text();
    bool is_known = false;
    for (const char* each : types) is_known = is_known || type == each;
    if (!is_known) throw FormatError("Column '" + name + "' has the type " + type + ".");
    const List& shape = entry["shape"].list();
    if (shape.empty() || shape.size() > 2 || size_at(shape, 0) != rows ||
        (shape.size() == 2 ? size_at(shape, 1) : 1) != width)
      throw FormatError("Column '" + name + "' has a wrong shape.");
    const std::string_view bytes = bytes_of(entry);
    if (bytes_of_type(type) == sizeof(T)) return numbers<T>(bytes);
    if (bytes_of_type(type) == 1) return widened<T, std::uint8_t>(bytes);
    return widened<T, std::uint16_t>(bytes);
  }

  bool has(const std::string& name) const { return outer_.find(name) != nullptr; }
  std::size_t rows_of(const std::string& name) const {
    return size_at(outer_[name]["shape"].list(), 0);
  }
  std::size_t width_of(const std::string& name) const {
    return size_at(outer_[name]["shape"].list(), 1);
  }

  Value inner;

 private:
  template <class T, class Narrow>
  static std::vector<T> widened(std::string_view bytes) {
    const std::vector<Narrow> values = numbers<Narrow>(bytes);
    return {values.begin(), values.end()};
  }
  static std::size_t size_at(const List& shape, std::size_t axis) {
    if (axis >= shape.size() || shape[axis].integer() < 0)
      throw FormatError("A column has a wrong shape.");
    return static_cast<std::size_t>(shape[axis].integer());
  }
  std::string_view bytes_of(const Value& entry) const {
    const List& offsets = entry["data_offsets"].list();
    const std::size_t begin = size_at(offsets, 0), end = size_at(offsets, 1);
    if (begin > end || end > body_.size()) throw FormatError("It is cut.");
    return body_.substr(begin, end - begin);
  }
  // The columns follow each other without gaps, as long as their shapes say, to the file's end.
  void check_columns() const {
    std::size_t end = 0;
    for (const auto& [name, entry] : outer_.object()) {
      if (name == "__metadata__") continue;
      std::size_t count = bytes_of_type(entry["dtype"].text());
      for (const Value& side : entry["shape"].list()) {
        const auto factor = static_cast<std::uint64_t>(side.integer());
        if (side.integer() < 0 || (factor && count > body_.size() / factor))
          throw FormatError("Column '" + name + "' is longer than the file.");
        count *= factor;
      }
      const List& offsets = entry["data_offsets"].list();
      if (size_at(offsets, 0) != end || bytes_of(entry).size() != count)
        throw FormatError("The place of column '" + name + "' does not fit its shape.");
      end += count;
    }
    if (end != body_.size()) throw FormatError("Its length does not fit its header.");
  }
  void check_sum() const {
    const std::string& stated = inner["sha256"].text();
    const std::string member = "\"sha256\":\"" + stated + "\",";
    const std::size_t at = inner_text_.find(member);
    if (at == std::string::npos) throw FormatError("Its header is not in canonical form.");
    Sha256 sum;
    sum.add(std::string(inner_text_).erase(at, member.size()));
    std::vector<std::pair<std::string, const Value*>> columns;
    for (const auto& [name, entry] : outer_.object())
      if (name != "__metadata__") columns.emplace_back(name, &entry);
    std::sort(columns.begin(), columns.end());
    for (const auto& [name, entry] : columns) {
      std::string head = "\n" + name + " " + (*entry)["dtype"].text() + " ";
      for (const Value& side : (*entry)["shape"].list())
        head += (head.back() == ' ' ? "" : ",") + std::to_string(side.integer());
      sum.add(head + "\n");
      sum.add(bytes_of(*entry));
    }
    if (sum.hex() != stated)
      throw FormatError("Its SHA-256 differs from its header, so it was altered.");
  }

  std::string_view data_, body_;
  std::string inner_text_;
  Value outer_;
};

template <class T, std::size_t n>
std::vector<std::array<T, n>> rows(const std::vector<T>& numbers) {
  std::vector<std::array<T, n>> result(numbers.size() / n);
  for (std::size_t i = 0; i < numbers.size(); ++i) result[i / n][i % n] = numbers[i];
  return result;
}

inline std::vector<std::string> names(const Value& list) {
  std::vector<std::string> result;
  for (const Value& each : list.list()) result.push_back(each.text());
  return result;
}

inline Map map_of(std::string_view data) {
  const MapFileReader file(data);
  const std::size_t n = file.rows_of("ids"), f = file.rows_of("frame_times");
  Map map;
  map.model_id = file.inner["model_id"].text();
  map.preprocessing = file.inner["preprocessing"].text();
  map.frame = file.inner["frame"].text();
  map.robots = names(file.inner["robots"]);
  if (const Value* sources = file.inner.find("sources")) map.sources = names(*sources);

  map.times = file.column<double>("frame_times", f, 1, {"F64"});
  map.positions = rows<double, 3>(file.column<double>("frame_positions", f, 3, {"F64"}));
  map.orientations =
      rows<float, 4>(file.column<float>("frame_orientations", f, 4, {"F32"}));
  map.ids = file.column<std::uint32_t>("ids", n, 1, {"U32"});
  map.robot = file.column<std::uint32_t>("robot", n, 1, {"U8", "U16"});
  map.capture = file.column<std::uint32_t>("frame_index", n, 1, {"U16", "U32"});
  map.code_bytes = file.width_of("codes");
  if (map.code_bytes == 0) throw FormatError("Its segments have no codes.");
  map.codes = file.column<std::int8_t>("codes", n, map.code_bytes, {"I8"});
  const auto steps = file.column<std::int16_t>("centroids", n, 3, {"I16"});

  if (file.has("extents"))
    map.extents =
        rows<std::uint8_t, 3>(file.column<std::uint8_t>("extents", n, 3, {"U8"}));
  if (file.has("points")) map.points = file.column<std::uint16_t>("points", n, 1, {"U16"});
  if (file.has("views")) map.views = file.column<std::uint32_t>("views", n, 1, {"U32"});
  if (file.has("seen")) map.seen = file.column<std::uint32_t>("seen", n, 1, {"U32"});
  if (file.has("source_ids"))
    map.source_ids = file.column<std::uint32_t>("source_ids", n, 1, {"U32"});
  if (file.has("source")) map.source = file.column<std::uint16_t>("source", n, 1, {"U16"});
  if (file.has("classes")) map.classes = file.column<std::uint8_t>("classes", n, 1, {"U8"});

  map.centroids.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (map.capture[i] >= f)
      throw FormatError("A segment names a capture that the file lacks.");
    if (map.robot[i] >= map.robots.size())
      throw FormatError("A segment names a robot that the file lacks.");
    if (!map.source.empty() && map.source[i] > map.sources.size())
      throw FormatError("A segment names a source that the file lacks.");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // Whole centimeters from the sensor, which is rounded to whole centimeters as well.
      const double sensor = std::nearbyint(100 * map.positions[map.capture[i]][axis]);
      map.centroids[i][axis] = (sensor + steps[3 * i + axis]) / 100;
    }
  }
  return map;
}

}  // namespace detail

// Decode a map file and check its checksum and tables.
inline Map decode_map(std::string_view data) {
  try {
    return detail::map_of(data);
  } catch (const FormatError& error) {
    throw FormatError("Invalid map file. " + std::string(error.what()) +
                      " Download the map again, or update this program.");
  }
}

// Read a map file from the disk.
inline Map read_map(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw FormatError("Cannot open the map file '" + path + "'. Check the path.");
  return decode_map(std::string(std::istreambuf_iterator<char>(stream), {}));
}

}  // namespace placecell
