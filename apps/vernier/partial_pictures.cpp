// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/partial_pictures.h"

#include <unistd.h>

#include <filesystem>
#include <limits>

#include "apps/vernier/picture_output.h"

namespace vernier::apps {
namespace {

/// What pipes and devices are given cannot be taken back.
bool can_be_replaced(const std::string& output) {
  std::error_code error;
  return !is_standard_stream(output) && !std::filesystem::is_other(output, error);
}

}  // namespace

void PartialPictures::attach(RenderSession& session, std::atomic<bool>& now) {
  const bool watched = ::isatty(STDERR_FILENO) != 0;
  const double never = std::numeric_limits<double>::infinity();
  session.on_preview([this, &session] { write(session); },
                     preview_interval(request_.flags.run, watched).value_or(never), &now);
}

void PartialPictures::write(const RenderSession& session) {
  const LayeredImage picture = session.picture(request_.layer_list);
  Metadata metadata = image_metadata(report_, request_.flags, session.result());
  metadata["vernier:stoppedBy"] = unfinished;
  for (const std::string& output : request_.flags.outputs) {
    if (!can_be_replaced(output)) continue;
    try {
      write_output(output, picture, metadata, request_);
    } catch (const Error& error) {
      log_.add({Notice::Severity::warning, {}, std::string(error.what()) + "; the render is not affected"});
    }
  }
}

}  // namespace vernier::apps
