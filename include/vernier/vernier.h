// SPDX-License-Identifier: Apache-2.0
#pragma once

// All of libvernier: read or describe a scene, build it, render it in a session, and show, denoise, compare
// or merge its pictures.

#include "vernier/error.h"
#include "vernier/ground.h"
#include "vernier/memory.h"
#include "vernier/picture.h"
#include "vernier/scene.h"
#include "vernier/scene_file.h"
#include "vernier/session.h"
#include "vernier/settings.h"
#include "vernier/version.h"
