// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/math/quadrature/gauss.hpp>

namespace vernier {

/// Calls visit(x, weight) for the nodes of the N-point Gauss-Legendre rule on [0, 1].
template <int N, typename Visit>
void for_each_gauss_node(const Visit& visit) {
  using Rule = boost::math::quadrature::gauss<float, N>;
  const auto& nodes = Rule::abscissa();
  const auto& weights = Rule::weights();
  for (size_t i = 0; i < nodes.size(); ++i) {
    visit((1 + nodes[i]) / 2, weights[i] / 2);
    if (nodes[i] != 0) visit((1 - nodes[i]) / 2, weights[i] / 2);
  }
}

}  // namespace vernier
