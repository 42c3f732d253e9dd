#include "processing/eigen_instances.h"

#ifdef LUMITEXEL_EIGEN_KERNELS
#pragma GCC diagnostic ignored "-Wignored-attributes"
namespace Eigen::internal {
LUMITEXEL_EIGEN_KERNELS()
}  // namespace Eigen::internal
namespace Eigen {
LUMITEXEL_EIGEN_DECOMPOSITIONS()
}  // namespace Eigen
#endif
