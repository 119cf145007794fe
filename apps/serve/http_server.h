// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "apps/serve/audience.h"
#include "apps/serve/live_render.h"

namespace vernier::apps {

/// What pages see and change.
struct Served {
  LiveRender& render;
  const LiveScene& scene;
  Audience& audience;
  std::string facts;  ///< facts_json(), as text
};

/// Answers the requests of pages: docs/serve.md lists them. Connections, and what each may send and how
/// often, are bounded.
class HttpServer {
 public:
  static constexpr size_t most_pages = 16;

  /// Listens from here on, on any free port for 0, without answering yet. Throws Error.
  HttpServer(const std::string& host, int port);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// For a browser; with a token unless only this machine can reach it.
  std::string address() const;

  /// Answers until stop() is called by another thread. Throws Error when it ends otherwise.
  void serve(Served served);
  /// Once the streams of events have been ended. Does nothing while serve() has not begun to answer.
  void stop();

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace vernier::apps
