// Sums over many samples that threads share, yet with the same bits for any number of threads: samples are summed in
// blocks of one fixed size, and the blocks in their order.
#pragma once

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lumitexel {

inline constexpr std::size_t kSumBlock = 2048;

template <typename PerItem>
void for_each_block(std::size_t count, const PerItem& per_item) {
  oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, count, kSumBlock),
                            [&](const oneapi::tbb::blocked_range<std::size_t>& range) {
                              for (std::size_t i = range.begin(); i != range.end(); ++i) per_item(i);
                            });
}

// add(i, sum) adds item i; Sum needs +=. `zero` is what a block begins with.
template <typename Sum, typename Add>
Sum ordered_sum(std::size_t count, const Sum& zero, const Add& add) {
  std::vector<Sum> blocks((count + kSumBlock - 1) / kSumBlock, zero);
  oneapi::tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
    const std::size_t end = std::min(count, (b + 1) * kSumBlock);
    for (std::size_t i = b * kSumBlock; i < end; ++i) add(i, blocks[b]);
  });
  Sum total = zero;
  for (const Sum& block : blocks) total += block;
  return total;
}

}  // namespace lumitexel
