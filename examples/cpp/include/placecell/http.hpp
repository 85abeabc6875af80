// One HTTP request and its answer. With PLACECELL_WITH_CURL, libcurl sends it, and https works.
// Otherwise a plain POSIX socket sends it, and only http works.
#pragma once

#include <algorithm>
#include <cctype>
#include <charconv>
#include <chrono>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#ifdef PLACECELL_WITH_CURL
#include <curl/curl.h>
#else
#include <cerrno>
#include <cstring>

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>
#endif

namespace placecell {

// Error: the service cannot be reached, or does not answer in time.
struct ConnectionError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct HttpRequest {
  std::string method, url, body;
  std::map<std::string, std::string> headers;
  double timeout_s = 30;                       // of the whole call
  std::size_t longest = std::size_t{1} << 30;  // bytes of an answer
};

struct HttpAnswer {
  int status = 0;
  std::map<std::string, std::string> headers;  // names in lower case
  std::string body;
};

namespace detail {

inline std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == text.npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1));
}

// Add one line of an answer's head to its headers.
inline void add_header(HttpAnswer& answer, std::string_view line) {
  const std::size_t colon = line.find(':');
  if (colon == line.npos) return;
  std::string name(line.substr(0, colon));
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  answer.headers[name] = trimmed(line.substr(colon + 1));
}

#ifdef PLACECELL_WITH_CURL

inline std::size_t take_body(char* data, std::size_t, std::size_t size, void* context) {
  auto& [answer, longest] = *static_cast<std::pair<HttpAnswer, std::size_t>*>(context);
  if (size > longest - answer.body.size()) return 0;  // ends the transfer
  answer.body.append(data, size);
  return size;
}

inline std::size_t take_header(char* data, std::size_t, std::size_t size, void* context) {
  add_header(static_cast<std::pair<HttpAnswer, std::size_t>*>(context)->first, {data, size});
  return size;
}

#else

// TCP connection with one deadline for all that happens on it.
class Connection {
 public:
  using Clock = std::chrono::steady_clock;

  Connection(const std::string& host, const std::string& port, double timeout_s)
      : where_(host + ":" + port),
        deadline_(Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                     std::chrono::duration<double>(timeout_s))) {
    addrinfo wanted{}, *found = nullptr;
    wanted.ai_socktype = SOCK_STREAM;
    if (const int code = getaddrinfo(host.c_str(), port.c_str(), &wanted, &found))
      throw ConnectionError("Cannot find the host of " + where_ + ": " + gai_strerror(code) +
                            ". Check the address of the service.");
    const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, freeaddrinfo);
    for (const addrinfo* each = found; each; each = each->ai_next)
      if (connect_to(*each)) return;
    throw ConnectionError("Cannot connect to " + where_ + ": " + std::strerror(error_) +
                          ". Check the address, and that the service runs.");
  }
  ~Connection() { end(); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void send(std::string_view data) {
    while (!data.empty()) {
      wait(POLLOUT);
      const ssize_t count = ::send(socket_, data.data(), data.size(), MSG_NOSIGNAL);
      if (count < 0 && errno != EAGAIN && errno != EINTR) {
        if (errno == EPIPE || errno == ECONNRESET) return;  // the answer says why
        throw broken();
      }
      if (count > 0) data.remove_prefix(static_cast<std::size_t>(count));
    }
  }

  // Append what has arrived; return false at the end of the connection.
  bool receive(std::string& out) {
    char buffer[65536];
    for (;;) {
      wait(POLLIN);
      const ssize_t count = ::recv(socket_, buffer, sizeof buffer, 0);
      if (count >= 0) {
        out.append(buffer, static_cast<std::size_t>(count));
        return count > 0;
      }
      if (errno != EAGAIN && errno != EINTR) throw broken();
    }
  }

 private:
  bool connect_to(const addrinfo& address) {
    socket_ = ::socket(address.ai_family, address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (socket_ < 0) return error_ = errno, false;
    if (::connect(socket_, address.ai_addr, address.ai_addrlen) == 0) return true;
    error_ = errno;
    if (error_ == EINPROGRESS) {
      wait(POLLOUT);
      socklen_t size = sizeof error_;
      ::getsockopt(socket_, SOL_SOCKET, SO_ERROR, &error_, &size);
      if (error_ == 0) return true;
    }
    end();
    return false;
  }
  void wait(short event) {
    using std::chrono::milliseconds;
    for (;;) {
      const auto left = std::chrono::duration_cast<milliseconds>(deadline_ - Clock::now()).count();
      pollfd watched{socket_, event, 0};
      if (left > 0 && ::poll(&watched, 1, static_cast<int>(std::min<long long>(left, 60'000))) > 0)
        return;
      if (left <= 0)
        throw ConnectionError("The service at " + where_ +
                              " did not answer in time. Check the link, or raise the timeout.");
    }
  }
  ConnectionError broken() const {
    return ConnectionError("The connection to " + where_ + " broke: " + std::strerror(errno) +
                           ". Repeat the request.");
  }
  void end() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
  }

  std::string where_;
  Clock::time_point deadline_;
  int socket_ = -1, error_ = 0;
};

// Join the chunks of a body with `Transfer-Encoding: chunked`.
inline std::string joined(std::string_view data) {
  std::string body;
  for (;;) {
    const std::size_t line = data.find("\r\n");
    std::size_t size = 0;
    const char* const end = data.data() + std::min(line, data.size());
    const auto done = std::from_chars(data.data(), end, size, 16);
    if (line == data.npos || done.ec != std::errc() || size > data.size() - line - 2)
      throw ConnectionError("The answer is cut. Repeat the request.");
    if (size == 0) return body;
    body += data.substr(line + 2, size);
    data.remove_prefix(std::min(data.size(), line + 2 + size + 2));
  }
}

#endif

}  // namespace detail

#ifdef PLACECELL_WITH_CURL

inline HttpAnswer send(const HttpRequest& request) {
  static const bool is_ready = curl_global_init(CURL_GLOBAL_DEFAULT) == CURLE_OK;
  const std::unique_ptr<CURL, decltype(&curl_easy_cleanup)> owner(
      is_ready ? curl_easy_init() : nullptr, curl_easy_cleanup);
  if (!owner) throw ConnectionError("libcurl does not start. Check its installation.");
  curl_slist* lines = nullptr;
  for (const auto& [name, value] : request.headers)
    lines = curl_slist_append(lines, (name + ": " + value).c_str());
  lines = curl_slist_append(lines, "Expect:");
  const std::unique_ptr<curl_slist, decltype(&curl_slist_free_all)> list(lines,
                                                                         curl_slist_free_all);
  std::pair<HttpAnswer, std::size_t> received{{}, request.longest};
  char reason[CURL_ERROR_SIZE] = "";
  CURL* curl = owner.get();
  curl_easy_setopt(curl, CURLOPT_URL, request.url.c_str());
  curl_easy_setopt(curl, CURLOPT_NOPROXY, "localhost,127.0.0.1,::1");
  curl_easy_setopt(curl, CURLOPT_CUSTOMREQUEST, request.method.c_str());
  if (!request.body.empty()) {
    curl_easy_setopt(curl, CURLOPT_POSTFIELDS, request.body.data());
    const auto size = static_cast<curl_off_t>(request.body.size());
    curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE_LARGE, size);
  }
  curl_easy_setopt(curl, CURLOPT_HTTPHEADER, lines);
  curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, static_cast<long>(1000 * request.timeout_s));
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl, CURLOPT_ERRORBUFFER, reason);
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, detail::take_body);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, &received);
  curl_easy_setopt(curl, CURLOPT_HEADERFUNCTION, detail::take_header);
  curl_easy_setopt(curl, CURLOPT_HEADERDATA, &received);
  if (const CURLcode code = curl_easy_perform(curl); code != CURLE_OK)
    throw ConnectionError("Cannot reach " + request.url + ": " +
                          (*reason ? reason : curl_easy_strerror(code)) +
                          ". Check the address, and that the service runs.");
  long status = 0;
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
  received.first.status = static_cast<int>(status);
  return std::move(received.first);
}

#else

// Send a request on a connection of its own, and read until the service closes it.
inline HttpAnswer send(const HttpRequest& request) {
  constexpr std::string_view scheme = "http://";
  if (request.url.compare(0, scheme.size(), scheme) != 0)
    throw ConnectionError("Cannot reach " + request.url +
                          ": this program was built without libcurl, so only http:// works. "
                          "Install the headers of libcurl and build again.");
  const std::string rest = request.url.substr(scheme.size());
  const std::size_t slash = std::min(rest.find('/'), rest.size());
  const std::string authority = rest.substr(0, slash);
  const std::string path = slash < rest.size() ? rest.substr(slash) : "/";
  std::size_t colon = authority.rfind(':');
  if (colon != authority.npos && authority.find(']', colon) != authority.npos)
    colon = authority.npos;  // within an IPv6 address
  std::string host = authority.substr(0, colon);
  const std::string port = colon == authority.npos ? "80" : authority.substr(colon + 1);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']')
    host = host.substr(1, host.size() - 2);

  std::string head = request.method + " " + path + " HTTP/1.1\r\nHost: " + authority +
                     "\r\nConnection: close\r\n";
  for (const auto& [name, value] : request.headers) head += name + ": " + value + "\r\n";
  if (!request.body.empty())
    head += "Content-Length: " + std::to_string(request.body.size()) + "\r\n";
  detail::Connection connection(host, port, request.timeout_s);
  connection.send(head + "\r\n");
  connection.send(request.body);
  std::string data;
  while (connection.receive(data))
    if (data.size() > request.longest)
      throw ConnectionError("The answer of " + request.url + " is longer than " +
                            std::to_string(request.longest) + " bytes.");

  const std::size_t end = data.find("\r\n\r\n");
  HttpAnswer answer;
  if (data.compare(0, 7, "HTTP/1.") != 0 || end == data.npos ||
      std::from_chars(data.data() + 9, data.data() + 12, answer.status).ec != std::errc())
    throw ConnectionError("The answer of " + request.url + " is not HTTP. Check the address.");
  for (std::size_t at = data.find("\r\n"); at < end;) {
    const std::size_t next = data.find("\r\n", at + 2);
    detail::add_header(answer, std::string_view(data).substr(at + 2, next - at - 2));
    at = next;
  }
  answer.body = data.substr(end + 4);
  if (answer.headers["transfer-encoding"] == "chunked") {
    answer.body = detail::joined(answer.body);
  } else if (const auto found = answer.headers.find("content-length");
             found != answer.headers.end() && found->second != std::to_string(answer.body.size())) {
    throw ConnectionError("The answer of " + request.url + " is cut. Repeat the request.");
  }
  return answer;
}

#endif

}  // namespace placecell
