// SPDX-License-Identifier: Apache-2.0
#include "apps/serve/routes.h"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>

#include "apps/serve/view_json.h"
#include "apps/serve/web_files.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

using httplib::Request;
using httplib::Response;
constexpr const char* json_type = "application/json";

/// Nothing but what this server sends may be loaded by its page, and no other site may show it in a frame.
constexpr const char* policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src "
    "'self'; "
    "frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

/// A whole number from 0 on.
std::optional<int> number(const Request& request, const char* name) {
  const std::string text = request.get_param_value(name);
  int value = -1;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size() || value < 0) return {};
  return value;
}

/// Of a request that was refused before it was looked into.
const char* problem_of(int status) {
  switch (status) {
    case 404:
      return "there is nothing at this address";
    case 413:
    case 414:
      return "this request is larger than any page sends";
    default:
      return "this is no request that can be answered";
  }
}

void send_file(Response& response, std::span<const unsigned char> bytes, const std::string& type) {
  response.set_content(reinterpret_cast<const char*>(bytes.data()), bytes.size(), type.c_str());
}

void add_page(httplib::Server& server) {
  for (const WebFile& file : web_files())
    server.Get(std::string(file.path), [file](const Request&, Response& response) {
      response.set_content(file.content.data(), file.content.size(), std::string(file.type).c_str());
    });
}

void add_pictures(httplib::Server& server, const Served& served) {
  server.Get("/picture", [served](const Request&, Response& response) {
    const auto frame = served.render.frame();
    if (!frame) return refuse(response, 404, "there is no picture yet");
    served.audience.note_fetch();
    response.set_header("Vernier-Frame", std::to_string(frame->number));
    response.set_header("Vernier-View", std::to_string(frame->view));
    send_file(response, frame->file, frame->type);
  });
  server.Get("/error-map", [served](const Request&, Response& response) {
    const auto frame = served.render.frame();
    const auto map = frame ? error_map(*frame) : std::nullopt;
    if (!map) return refuse(response, 404, "the errors are not known yet");
    response.set_header("Vernier-Largest", map->largest);
    send_file(response, map->file, "image/jpeg");
  });
  server.Get("/pixel", [served](const Request& request, Response& response) {
    const auto x = number(request, "x"), y = number(request, "y");
    if (!x || !y) return refuse(response, 400, "expected ?x=COLUMN&y=ROW, whole numbers from 0");
    const auto frame = served.render.frame();
    if (!frame) return refuse(response, 404, "there is no picture yet");
    response.set_content(pixel_json(*x, *y, *frame, served.scene).dump(), json_type);
  });
}

void add_view(httplib::Server& server, const Served& served) {
  server.Get("/facts", [facts = served.facts](const Request&, Response& response) {
    response.set_content(facts, json_type);
  });
  server.Post("/view", [served](const Request& request, Response& response) {
    try {
      const auto change = nlohmann::json::parse(request.body);
      response.set_content(fmt::format("{{\"view\":{}}}", served.render.change(change)), json_type);
    } catch (const nlohmann::json::exception&) {
      refuse(response, 400, "expected JSON: an object of flags and their values, as texts");
    } catch (const Error& error) {
      refuse(response, 400, error.what());
    }
  });
  server.Get("/events", [served](const Request&, Response& response) {
    const auto seat = served.audience.admit();
    if (!seat)
      return refuse(
          response, 503,
          fmt::format("{} pages are open, which is all there may be; close one", HttpServer::most_pages));
    response.set_chunked_content_provider("text/event-stream", [seat](size_t, httplib::DataSink& sink) {
      const auto news = seat->next();
      return news && sink.write(news->data(), news->size());
    });
  });
}

}  // namespace

void refuse(Response& response, int status, const std::string& problem) {
  response.status = status;
  response.set_content(nlohmann::json{{"problem", problem}}.dump(), json_type);
}

void add_routes(httplib::Server& server, Served served) {
  server.set_default_headers({{"Cache-Control", "no-store"},
                              {"Content-Security-Policy", policy},
                              {"X-Content-Type-Options", "nosniff"},
                              {"Referrer-Policy", "no-referrer"}});
  server.set_error_handler([](const Request&, Response& response) {
    if (response.body.empty()) refuse(response, response.status, problem_of(response.status));
  });
  server.set_exception_handler([](const Request&, Response& response, const std::exception_ptr&) {
    refuse(response, 500, "this request failed; the server goes on");
  });
  add_page(server);
  add_pictures(server, served);
  add_view(server, served);
}

}  // namespace vernier::apps
