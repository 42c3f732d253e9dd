// Speed of the float kernels over many geometries: against the double ones, against what the vector units could do, and their error.
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "processing/brdf/evaluate_packed.h"
#include "processing/brdf/numerics/synthetic_observations.h"
#include "tests/bench/machine.h"

namespace {

using namespace lumitexel;

// Float arithmetic of one Lafortune lobe in three channels, counted in packed_lobes.h and float_lanes.h: sums and products, fused ones
// as one. base 29, logarithm 26, power 18, exponential 10, channels 9.
constexpr double kOperationsALobe = 92.0;

double thread_time_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <typename Work>
double best_ns(std::size_t count, int repeats, const Work& work) {
  double best = 1e300;
  for (int i = 0; i < repeats; ++i) {
    const double start = thread_time_s();
    work();
    best = std::min(best, thread_time_s() - start);
  }
  return best * 1e9 / static_cast<double>(count);
}

#if defined(__x86_64__)
// Twelve chains in registers hide the latency.
#define FUSED(r, n) "vfmadd213ps %%" r "15, %%" r "14, %%" r n "\n\t"
#define TWELVE_FUSED(r) \
  FUSED(r, "0") FUSED(r, "1") FUSED(r, "2") FUSED(r, "3") FUSED(r, "4") FUSED(r, "5") FUSED(r, "6") FUSED(r, "7") FUSED(r, "8") FUSED(r, "9") \
  FUSED(r, "10") FUSED(r, "11")
#define CLOBBERED \
  "xmm0", "xmm1", "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8", "xmm9", "xmm10", "xmm11", "xmm14", "xmm15"

// Float fused multiply-adds a second with all lanes at work. Processors that can add elsewhere at the same time may get past it.
double fused_a_second(VectorWidth width) {
  constexpr int kChains = 12, kRounds = 4'000'000;
  const double start = thread_time_s();
  if (width == VectorWidth::Avx512) {
    for (int i = 0; i < kRounds; ++i) asm volatile(TWELVE_FUSED("zmm") ::: CLOBBERED);
  } else {
    for (int i = 0; i < kRounds; ++i) asm volatile(TWELVE_FUSED("ymm") ::: CLOBBERED);
  }
  return (width == VectorWidth::Avx512 ? 16.0 : 8.0) * kChains * kRounds / (thread_time_s() - start);
}
#else
double fused_a_second(VectorWidth) { return std::nan(""); }
#endif

double largest_error(const Brdf& brdf, const std::vector<LobeGeometry>& geometries, const std::vector<float>& values) {
  double largest = 0.0;
  for (std::size_t i = 0; i < geometries.size(); ++i) {
    const double wanted = evaluate(brdf, 0, geometries[i]);
    largest = std::max(largest, std::abs(static_cast<double>(values[i]) - wanted) / wanted);
  }
  return largest;
}

void print_family(BrdfFamily family, const std::vector<LobeGeometry>& geometries, const PackedGeometries& packed, int repeats) {
  Brdf brdf = shiny_brdf(0.1, 1.0, 30.0);
  brdf.family = family;
  if (family != BrdfFamily::Lafortune) brdf.lobes[0].fill({-3.0, -1.5, kMirrorAim});
  std::vector<float> values(3 * packed.size());
  double sum = 0.0;
  const double one_by_one = best_ns(geometries.size(), repeats / 10 + 1, [&] {
    for (const LobeGeometry& geometry : geometries) sum += evaluate(brdf, geometry)[0];
  });
  std::printf("%-10s %-8s %9.2f ns\n", to_string(family), "double", one_by_one);
  for (const auto& [width, name] :
       {std::pair(VectorWidth::Scalar, "scalar"), std::pair(VectorWidth::Avx2, "AVX2"), std::pair(VectorWidth::Avx512, "AVX-512")}) {
    if (width > widest_vectors()) continue;
    const double ns = best_ns(packed.size(), repeats, [&] { evaluate(brdf, packed, values, width); });
    std::printf("%-10s %-8s %9.2f ns  %6.1f times double  largest relative error %.1e", to_string(family), name, ns, one_by_one / ns,
                largest_error(brdf, geometries, values));
    if (family == BrdfFamily::Lafortune && width != VectorWidth::Scalar) {
      std::printf("  %3.0f %% of the bound", 100.0 * kOperationsALobe / (ns * 1e-9) / fused_a_second(width));
    }
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t count = 8192;
  int repeats = 300;
  CLI::App app{"Float kernels over many geometries: time for three channels that share one lobe"};
  app.add_option("--count", count, "geometries; 8192 stay in the second cache, a million do not");
  app.add_option("--repeats", repeats, "of which the fastest counts");
  CLI11_PARSE(app, argc, argv);
  RandomNumbers random(1);
  std::vector<LobeGeometry> geometries;
  PackedGeometries packed;
  for (std::size_t i = 0; i < count; ++i) {
    geometries.push_back(random_sample(shiny_brdf(0.1, 1.0, 30.0), 0.0, random).geometry);
    packed.add(geometries.back());
  }
  std::printf("%s\n%zu geometries, one core\n", machine_line().c_str(), count);
  for (const auto& [width, name] : {std::pair(VectorWidth::Avx2, "AVX2"), std::pair(VectorWidth::Avx512, "AVX-512")}) {
    if (width <= widest_vectors()) std::printf("bound: %.1f G fused multiply-adds a second with %s\n", fused_a_second(width) * 1e-9, name);
  }
  for (const BrdfFamily family : {BrdfFamily::Lafortune, BrdfFamily::Ggx, BrdfFamily::Ward}) print_family(family, geometries, packed, repeats);
  return 0;
}
