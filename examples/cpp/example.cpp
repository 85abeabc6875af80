// Describe a scan, localize it, and read a map: each command is a few lines with placecell.hpp.
//
//   placecell_example describe URL SCAN.json
//   placecell_example localize URL SCAN.json [--near X Y Z RADIUS] [MAP...]
//   placecell_example download URL MAP FILE
//   placecell_example map FILE
//
// SCAN.json holds the segments of one scan, as in docs/reference/http-api.md. The environment
// variable PLACECELL_KEY holds the API key, if the service has keys. Each answer is a line of JSON;
// numbers have all their digits.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include "placecell.hpp"

namespace {

using Arguments = std::vector<std::string>;

constexpr const char* usage =
    "usage: placecell_example describe URL SCAN.json\n"
    "       placecell_example localize URL SCAN.json [--near X Y Z RADIUS] [MAP...]\n"
    "       placecell_example download URL MAP FILE\n"
    "       placecell_example map FILE\n";

placecell::Client client_of(const std::string& url) {
  placecell::ClientOptions options;
  if (const char* key = std::getenv("PLACECELL_KEY")) options.key = key;
  return placecell::Client(url, options);
}

std::vector<placecell::Segment> read_scan(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw placecell::FormatError("Cannot open '" + path + "'. Check the path.");
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  std::vector<placecell::Segment> segments;
  const placecell::Value scan = placecell::from_json(text);
  for (const placecell::Value& item : scan["segments"].list()) {
    placecell::Segment segment{};
    for (const placecell::Value& point : item["points"].list()) {
      const auto& axes = point.list();
      if (axes.size() != 3) throw placecell::FormatError("A point does not have 3 coordinates.");
      segment.points.push_back({static_cast<float>(axes[0].number()),
                                static_cast<float>(axes[1].number()),
                                static_cast<float>(axes[2].number())});
    }
    const auto& sensor = item["sensor"].list();
    if (sensor.size() != 3) throw placecell::FormatError("A sensor does not have 3 coordinates.");
    for (std::size_t axis = 0; axis < 3; ++axis) segment.sensor[axis] = sensor[axis].number();
    segments.push_back(std::move(segment));
  }
  return segments;
}

// JSON text of what is printed.
std::string json(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", number);
  return text;
}
std::string json(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}
template <class Sequence>
std::string json(const Sequence& values) {
  std::string text;
  for (const auto& each : values) text += (text.empty() ? "" : ",") + json(each);
  return "[" + text + "]";
}
template <class T>
std::string hex(const T* numbers, std::size_t count) {
  std::string text;
  const auto* bytes = reinterpret_cast<const unsigned char*>(numbers);
  for (std::size_t i = 0; i < count * sizeof(T); ++i) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", bytes[i]);
    text += digits;
  }
  return "\"" + text + "\"";
}

void describe(const Arguments& arguments) {
  const auto description = client_of(arguments[0]).describe(read_scan(arguments[1]));
  for (const auto& each : description.descriptors) {
    if (!each.error.empty())
      std::cout << "{\"error\":" << json(each.error) << "}\n";
    else
      std::cout << "{\"codes\":" << hex(each.codes.data(), each.codes.size())
                << ",\"descriptor\":" << hex(each.values.data(), each.values.size())
                << ",\"centroid\":" << json(each.centroid) << "}\n";
  }
}

void localize(const Arguments& arguments) {
  placecell::LocalizeOptions options;
  auto maps = arguments.begin() + 2;
  if (arguments.size() >= 7 && *maps == "--near") {
    const auto number = [&](int at) { return placecell::from_json(maps[at]).number(); };
    options.hints = placecell::near({number(1), number(2), number(3)}, number(4));
    maps += 5;
  }
  options.maps.assign(maps, arguments.end());
  const auto found = client_of(arguments[0]).localize(read_scan(arguments[1]), options);
  for (const auto& each : found.maps) {
    std::cout << "{\"map\":" << json(each.map) << ",\"frame\":" << json(each.frame)
              << ",\"probability\":" << json(each.probability) << ",\"score\":" << json(each.score);
    if (each.pose)
      std::cout << ",\"translation\":" << json(each.pose->translation)
                << ",\"rotation\":" << json(each.pose->rotation)
                << ",\"yaw\":" << json(each.pose->yaw)
                << ",\"covariance\":" << json(each.covariance);
    else
      std::cout << ",\"reason\":" << json(each.reason) << ",\"detail\":" << json(each.detail)
                << ",\"advice\":" << json(each.advice);
    std::cout << ",\"inliers\":[";
    for (std::size_t i = 0; i < each.inliers.size(); ++i)
      std::cout << (i ? ",[" : "[") << each.inliers[i].query << "," << each.inliers[i].id << ","
                << json(each.inliers[i].residual) << "]";
    std::cout << "]}\n";
  }
}

void download(const Arguments& arguments) {
  const std::string data = client_of(arguments[0]).get_map_file(arguments[1]);
  placecell::decode_map(data);  // nothing broken is written
  std::ofstream stream(arguments[2], std::ios::binary);
  stream.write(data.data(), static_cast<std::streamsize>(data.size()));
  if (!stream.flush())
    throw placecell::FormatError("Cannot write '" + arguments[2] + "'. Check path and space.");
}

void print_map(const Arguments& arguments) {
  const placecell::Map map = placecell::read_map(arguments[0]);
  std::cout << "{\"segments\":" << map.size() << ",\"frame\":" << json(map.frame)
            << ",\"model_id\":" << json(map.model_id) << ",\"robots\":" << json(map.robots)
            << ",\"sources\":" << json(map.sources) << "}\n";
  for (std::size_t i = 0; i < map.size(); ++i)
    std::cout << "{\"id\":" << map.ids[i] << ",\"robot\":" << json(map.robots[map.robot[i]])
              << ",\"time\":" << json(map.times[map.capture[i]])
              << ",\"sensor\":" << json(map.positions[map.capture[i]])
              << ",\"centroid\":" << json(map.centroids[i])
              << ",\"class\":" << (map.classes.empty() ? 0 : int{map.classes[i]})
              << ",\"codes\":" << hex(&map.codes[i * map.code_bytes], map.code_bytes) << "}\n";
}

}  // namespace

int main(int count, char** values) try {
  const std::string command = count > 1 ? values[1] : "";
  const Arguments rest(values + std::min(count, 2), values + count);
  if (command == "describe" && rest.size() == 2)
    describe(rest);
  else if (command == "localize" && rest.size() >= 2)
    localize(rest);
  else if (command == "download" && rest.size() == 3)
    download(rest);
  else if (command == "map" && rest.size() == 1)
    print_map(rest);
  else
    return std::cerr << usage, 2;
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
