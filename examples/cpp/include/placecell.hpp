// Client of a Placecell service, in headers only: C++17, little-endian machines.
//
//   placecell::Client client("http://127.0.0.1:8000");
//   placecell::LocalizeOptions options;
//   options.maps = {"yard"};
//   const auto found = client.localize(segments, options);
//   if (const auto* best = found.best()) use(best->pose->translation, best->pose->rotation);
//
// Errors are exceptions: ServiceError (the service refused, and says why), ConnectionError (it
// cannot be reached, or not in time), FormatError (an answer or a file is broken).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "placecell/http.hpp"
#include "placecell/map_file.hpp"
#include "placecell/value.hpp"

namespace placecell {

// Return the hint that the sensor is within a radius of a position in the map; meters.
inline Object near(const std::array<double, 3>& position, double radius) {
  return {{"near", Object{{"position", position}, {"radius", radius}}}};
}

// Error: the service refused a request or failed; docs/reference/errors.md lists the types.
struct ServiceError : std::runtime_error {
  ServiceError(int status_, std::string type_, const std::string& title, const std::string& detail,
               double retry_after_s_)
      : std::runtime_error(std::to_string(status_) + " " + title + ": " + detail),
        status(status_),
        type(std::move(type_)),
        retry_after_s(retry_after_s_) {}

  int status;            // of HTTP
  std::string type;      // `urn:placecell:problem:...`; stays the same between releases
  double retry_after_s;  // seconds after which to repeat the request; negative: not told
};

struct Point {
  float x, y, z;
};
static_assert(sizeof(Point) == 12, "points are sent as they lie in memory");

// Points that region growing found, meters, in one z-up frame with all others of a request.
struct Segment {
  std::vector<Point> points;
  std::array<double, 3> sensor;  // position of the sensor at the capture
};

// Descriptor of a segment, or the reason why it has none.
struct Descriptor {
  std::vector<std::int8_t> codes;  // stored form, for maps
  std::vector<float> values;       // before quantization
  std::array<double, 3> centroid{};
  std::string error;  // empty if there is a descriptor
};

struct Description {
  std::string model_id;
  std::vector<Descriptor> descriptors;  // one a segment, in order
};

// Transform from the frame of the request into the map's frame.
struct Pose {
  std::array<double, 3> translation;  // meters
  std::array<double, 4> rotation;     // unit quaternion x, y, z, w
  double yaw;                         // radians
};

struct Inlier {
  std::size_t query;  // index in the request
  std::uint32_t id;   // segment of the map
  double residual;    // meters
};

// Localization in one map: a pose, or the reason why there is none.
struct Localization {
  std::string map, frame;
  std::optional<Pose> pose;
  std::string reason, detail, advice;  // empty with a pose
  double probability = 0;
  std::vector<std::vector<double>> covariance;  // 4 x 4 (x, y, z, yaw) or 6 x 6; empty without pose
  double score = 0;
  std::vector<Inlier> inliers;
};

struct Localizations {
  std::string model_id;
  std::vector<Localization> maps;  // the most probable first

  // Return the most probable localization that has a pose; nullptr if the robot is not localized.
  const Localization* best() const {
    const Localization* found = nullptr;
    for (const Localization& each : maps)
      if (each.pose && (!found || std::pair(each.probability, each.score) >
                                      std::pair(found->probability, found->score)))
        found = &each;
    return found;
  }
};

struct LocalizeOptions {
  std::vector<std::string> maps;  // names of the maps to search; none: all maps
  int k = 25;                     // candidates a segment
  std::string motion = "yaw";     // or "se3": all six degrees of freedom
  std::string session;            // name of this robot's session; all its requests are in one frame
  Object hints;                   // where the robot is, as docs/reference/http-api.md has `hints`
};

struct ClientOptions {
  std::string key;        // API key, if the service has keys
  double timeout_s = 30;  // of a call
};

class Client {
 public:
  explicit Client(std::string base_url, ClientOptions options = {})
      : base_(std::move(base_url)), options_(std::move(options)) {
    if (base_.find("http://") != 0 && base_.find("https://") != 0)
      throw std::invalid_argument("Invalid address '" + base_ +
                                  "': expected http://HOST:PORT or https://HOST.");
    while (base_.back() == '/') base_.pop_back();
    for (const unsigned char c : options_.key)
      if (c <= ' ' || c > '~')
        throw std::invalid_argument("Invalid key: expected visible ASCII characters only.");
  }

  // Return version, default model, limits and costs of the service.
  Value info() const { return from_json(call("GET", "/info").body); }

  // Compute the descriptors of the segments of one scan.
  Description describe(const std::vector<Segment>& segments) const {
    return reading([&] {
      const Value answer = post("/describe", Object{{"segments", list_of(segments)}});
      Description result{answer["model_id"].text(), {}};
      for (const Value& item : answer["descriptors"].list())
        result.descriptors.push_back(descriptor_of(item));
      if (result.descriptors.size() != segments.size())
        throw FormatError("The answer has another number of descriptors than segments.");
      return result;
    });
  }

  // Localize the robot by all segments around it, in the robot's frame.
  Localizations localize(const std::vector<Segment>& segments,
                         const LocalizeOptions& options = {}) const {
    return reading([&] {
      Object body{{"k", options.k}};
      if (!options.maps.empty())
        body.emplace_back("maps", List(options.maps.begin(), options.maps.end()));
      body.emplace_back("motion", options.motion);
      if (!options.session.empty()) body.emplace_back("session", options.session);
      if (!options.hints.empty()) body.emplace_back("hints", options.hints);
      body.emplace_back("segments", list_of(segments));
      // A balancer sends all requests of a session to one replica.
      std::map<std::string, std::string> headers;
      if (!options.session.empty())
        headers["Placecell-Session"] = std::to_string(std::hash<std::string>{}(options.session));
      const Value answer = post("/localize", std::move(body), std::move(headers));
      Localizations result{answer["model_id"].text(), {}};
      for (const Value& item : answer["localizations"].list())
        result.maps.push_back(localization_of(item));
      return result;
    });
  }

  // Download a map as a file.
  std::string get_map_file(const std::string& name) const {
    HttpAnswer answer = call("GET", "/maps/" + name);
    if (const auto tag = answer.headers.find("etag"); tag != answer.headers.end())
      seen_->note(name, tag->second);
    return std::move(answer.body);
  }

  // Download a map and decode it.
  Map get_map(const std::string& name) const { return decode_map(get_map_file(name)); }

 private:
  HttpAnswer call(const std::string& method, const std::string& path, std::string body = {},
                  std::map<std::string, std::string> headers = {}) const {
    HttpRequest request;
    for (auto& [name, value] : headers) request.headers[name] = std::move(value);
    request.method = method;
    request.url = base_ + path;
    request.timeout_s = options_.timeout_s;
    if (!options_.key.empty()) request.headers["Authorization"] = "Bearer " + options_.key;
    if (!body.empty()) {
      request.headers["Content-Type"] = "application/msgpack";
      request.headers["Accept"] = "application/msgpack";
    }
    request.body = std::move(body);
    const std::string seen = seen_->header();
    if (!seen.empty()) request.headers["Placecell-Seen"] = seen;
    HttpAnswer answer = send(request);
    if (answer.status < 200 || answer.status > 299) throw error_of(answer);
    return answer;
  }

  Value post(const std::string& path, Object body,
             std::map<std::string, std::string> headers = {}) const {
    const HttpAnswer answer =
        call("POST", path, to_msgpack(std::move(body)), std::move(headers));
    const auto type = answer.headers.find("content-type");
    if (type == answer.headers.end() || type->second.find("application/msgpack") != 0)
      throw FormatError("it is not msgpack.");
    return from_msgpack(answer.body);
  }

  // Run a function that reads an answer; say so in its errors.
  template <class Function>
  static std::invoke_result_t<Function> reading(Function function) {
    try {
      return function();
    } catch (const FormatError& error) {
      throw FormatError("The answer of the service is unreadable: " + std::string(error.what()) +
                        " Check that the address is that of a Placecell service.");
    }
  }

  // Build from an error answer of the service, or of a proxy.
  static ServiceError error_of(const HttpAnswer& answer) {
    double retry_after_s = -1;
    if (const auto found = answer.headers.find("retry-after"); found != answer.headers.end()) {
      const std::string& text = found->second;
      std::from_chars(text.data(), text.data() + text.size(), retry_after_s);
    }
    try {
      const Value problem = from_json(answer.body);
      return {answer.status, problem["type"].text(), problem["title"].text(),
              problem["detail"].text(), retry_after_s};
    } catch (const FormatError&) {
      return {answer.status, "about:blank", "Error of another server", answer.body.substr(0, 200),
              retry_after_s};
    }
  }

  static List list_of(const std::vector<Segment>& segments) {
    List result;
    for (const Segment& segment : segments) {
      std::string bytes;
      bytes.reserve(sizeof(Point) * segment.points.size());
      for (const Point& point : segment.points)  // points that were not measured are left out
        if (std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z))
          bytes.append(reinterpret_cast<const char*>(&point), sizeof point);
      result.push_back(Object{{"points", Blob{std::move(bytes)}}, {"sensor", segment.sensor}});
    }
    return result;
  }

  template <std::size_t n>
  static std::array<double, n> array_of(const Value& value) {
    const List& list = value.list();
    if (list.size() != n)
      throw FormatError("A list does not have " + std::to_string(n) + " items.");
    std::array<double, n> result;
    for (std::size_t i = 0; i < n; ++i) result[i] = list[i].number();
    return result;
  }
  static std::string text_of(const Value& value) {
    return value.is_null() ? std::string() : value.text();
  }

  static Descriptor descriptor_of(const Value& item) {
    Descriptor result;
    if (const Value* error = item.find("error")) {
      result.error = (*error)["title"].text() + ": " + (*error)["detail"].text();
      return result;
    }
    result.codes = numbers<std::int8_t>(item["codes"].blob());
    result.values = numbers<float>(item["descriptor"].blob());
    result.centroid = array_of<3>(item["centroid"]);
    return result;
  }

  static Localization localization_of(const Value& item) {
    Localization result;
    result.map = item["map"].text();
    result.frame = item["frame"].text();
    result.reason = text_of(item["reason"]);
    result.detail = text_of(item["detail"]);
    if (const Value* advice = item.find("advice")) result.advice = text_of(*advice);
    result.probability = item["probability"].number();
    result.score = item["score"].number();
    if (const Value& pose = item["pose"]; !pose.is_null())
      result.pose = Pose{array_of<3>(pose["translation"]), array_of<4>(pose["rotation"]),
                         pose["yaw"].number()};
    if (const Value& covariance = item["covariance"]; !covariance.is_null())
      for (const Value& row : covariance.list()) {
        result.covariance.emplace_back();
        for (const Value& each : row.list()) result.covariance.back().push_back(each.number());
      }
    for (const Value& each : item["inliers"].list())
      result.inliers.push_back({static_cast<std::size_t>(each["query"].integer()),
                                static_cast<std::uint32_t>(each["id"].integer()),
                                each["residual"].number()});
    return result;
  }

  // Versions of the last downloaded maps. With them, no replica answers by an older version.
  class Seen {
   public:
    void note(const std::string& map, const std::string& tag) {
      const std::lock_guard<std::mutex> held(lock_);
      if (tags_.size() >= 16 && tags_.count(map) == 0) tags_.erase(tags_.begin());
      tags_[map] = tag;
    }
    std::string header() const {
      const std::lock_guard<std::mutex> held(lock_);
      std::string text;
      for (const auto& [map, tag] : tags_) text += (text.empty() ? "" : ", ") + map + " " + tag;
      return text;
    }

   private:
    mutable std::mutex lock_;
    std::map<std::string, std::string> tags_;
  };

  std::string base_;
  ClientOptions options_;
  std::shared_ptr<Seen> seen_ = std::make_shared<Seen>();
};

}  // namespace placecell
