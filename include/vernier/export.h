// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks what libvernier exports; everything else in it is hidden.
#define VERNIER_API __attribute__((visibility("default")))
