// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <httplib.h>

#include <string>

#include "apps/serve/http_server.h"

namespace vernier::apps {

/// Answers with a problem, as JSON.
void refuse(httplib::Response& response, int status, const std::string& problem);

/// What is answered to which request. `served` must outlive the server's work.
void add_routes(httplib::Server& server, Served served);

}  // namespace vernier::apps
