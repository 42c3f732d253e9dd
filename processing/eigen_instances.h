// What of Eigen is compiled once, in eigen_instances.cpp, and not again in each file that needs it: the kernels that multiply matrices of
// doubles of any size (forty files, two seconds each), and decompositions of sizes that several files have. Part of the precompiled headers,
// so that no file has to think of it: without it everything works and gives the same bits, and only compiles slower.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>

// What there is to compile is Eigen's own affair and may change with its version.
#if EIGEN_WORLD_VERSION == 3 && EIGEN_MAJOR_VERSION == 4 && EIGEN_MINOR_VERSION == 0

#define LUMITEXEL_EIGEN_KERNELS(declare)                                                                                                   \
  declare template struct gebp_kernel<double, double, Index, blas_data_mapper<double, Index, ColMajor>, DoubleGebp::mr,                    \
                                      DoubleGebp::nr, false, false>;                                                                       \
  declare template struct gemm_pack_lhs<double, Index, const_blas_data_mapper<double, Index, ColMajor>, DoubleGebp::mr,                    \
                                        DoubleGebp::LhsProgress, DoubleGebp::LhsPacket4Packing, ColMajor, false, false>;                   \
  declare template struct gemm_pack_lhs<double, Index, const_blas_data_mapper<double, Index, RowMajor>, DoubleGebp::mr,                    \
                                        DoubleGebp::LhsProgress, DoubleGebp::LhsPacket4Packing, RowMajor, false, false>;                   \
  declare template struct gemm_pack_rhs<double, Index, const_blas_data_mapper<double, Index, ColMajor>, DoubleGebp::nr, ColMajor>;         \
  declare template struct gemm_pack_rhs<double, Index, const_blas_data_mapper<double, Index, RowMajor>, DoubleGebp::nr, RowMajor>;         \
  declare template struct gemm_pack_rhs<double, Index, blas_data_mapper<double, Index, ColMajor>, DoubleGebp::nr, ColMajor, false,         \
                                        true>;                                                                                             \
  declare template struct general_matrix_vector_product<Index, double, const_blas_data_mapper<double, Index, ColMajor>, ColMajor,          \
                                                        false, double, const_blas_data_mapper<double, Index, ColMajor>, false>;            \
  declare template struct general_matrix_vector_product<Index, double, const_blas_data_mapper<double, Index, ColMajor>, ColMajor,          \
                                                        false, double, const_blas_data_mapper<double, Index, RowMajor>, false>;            \
  declare template struct general_matrix_vector_product<Index, double, const_blas_data_mapper<double, Index, RowMajor>, RowMajor,          \
                                                        false, double, const_blas_data_mapper<double, Index, ColMajor>, false>;            \
  declare template struct general_matrix_vector_product<Index, double, const_blas_data_mapper<double, Index, RowMajor>, RowMajor,          \
                                                        false, double, const_blas_data_mapper<double, Index, RowMajor>, false, 1>;         \
  declare template struct triangular_solve_matrix<double, Index, OnTheLeft, Lower, false, ColMajor, ColMajor, 1>;                          \
  declare template struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, ColMajor, ColMajor, 1>;                          \
  declare template struct triangular_solve_matrix<double, Index, OnTheLeft, UnitLower, false, ColMajor, ColMajor, 1>;                      \
  declare template struct triangular_solve_matrix<double, Index, OnTheLeft, UnitUpper, false, RowMajor, ColMajor, 1>;                      \
  declare template struct triangular_solve_matrix<double, Index, OnTheRight, Upper, false, RowMajor, ColMajor, 1>;                         \
  declare template struct product_triangular_matrix_matrix<double, Index, Lower, true, ColMajor, false, ColMajor, false, ColMajor, 1, 0>;  \
  declare template struct product_triangular_matrix_matrix<double, Index, Upper, true, RowMajor, false, ColMajor, false, ColMajor, 1, 0>;  \
  declare template struct product_triangular_matrix_matrix<double, Index, UnitLower, true, ColMajor, false, ColMajor, false, ColMajor, 1, 0>;\
  declare template struct product_triangular_matrix_matrix<double, Index, UnitUpper, true, RowMajor, false, ColMajor, false, ColMajor, 1, 0>;\
  declare template struct triangular_matrix_vector_product<Index, UnitUpper, double, false, double, false, RowMajor, 0>;                   \
  declare template struct selfadjoint_matrix_vector_product<double, Index, ColMajor, Lower, false, false, 0>;

#define LUMITEXEL_EIGEN_LDLT(declare, Square) declare template LDLT<Square>& LDLT<Square>::compute<Square>(const EigenBase<Square>&);
#define LUMITEXEL_EIGEN_LDLT_SOLVE(declare, Square, Right, Result) \
  declare template void LDLT<Square>::_solve_impl_transposed<true, Right, Result>(const Right&, Result&) const;
#define LUMITEXEL_EIGEN_SYMMETRIC(declare, Square) \
  declare template SelfAdjointEigenSolver<Square>& SelfAdjointEigenSolver<Square>::compute<Square>(const EigenBase<Square>&, int);

#define LUMITEXEL_EIGEN_DECOMPOSITIONS(declare)                                                 \
  LUMITEXEL_EIGEN_LDLT(declare, MatrixXd)                                                       \
  LUMITEXEL_EIGEN_LDLT(declare, Matrix3d)                                                       \
  LUMITEXEL_EIGEN_LDLT(declare, Matrix6d)                                                       \
  LUMITEXEL_EIGEN_LDLT(declare, Matrix8d)                                                       \
  LUMITEXEL_EIGEN_LDLT(declare, UpTo8x8)                                                        \
  LUMITEXEL_EIGEN_LDLT_SOLVE(declare, MatrixXd, VectorXd, VectorXd)                             \
  LUMITEXEL_EIGEN_LDLT_SOLVE(declare, MatrixXd, MatrixXd, MatrixXd)                             \
  LUMITEXEL_EIGEN_LDLT_SOLVE(declare, MatrixXd, MatrixXd::IdentityReturnType, MatrixXd)         \
  LUMITEXEL_EIGEN_LDLT_SOLVE(declare, Matrix3d, Vector3d, Vector3d)                             \
  LUMITEXEL_EIGEN_LDLT_SOLVE(declare, Matrix6d, Vector6d, Vector6d)                             \
  LUMITEXEL_EIGEN_LDLT_SOLVE(declare, UpTo8x8, UpTo8, UpTo8)                                    \
  LUMITEXEL_EIGEN_SYMMETRIC(declare, MatrixXd)                                                  \
  LUMITEXEL_EIGEN_SYMMETRIC(declare, Matrix3d)                                                  \
  LUMITEXEL_EIGEN_SYMMETRIC(declare, Matrix8d)                                                  \
  declare template LLT<MatrixXd>& LLT<MatrixXd>::compute<MatrixXd>(const EigenBase<MatrixXd>&); \
  declare template void PartialPivLU<MatrixXd>::compute();                                      \
  declare template void ColPivHouseholderQR<MatrixXd>::computeInPlace();                        \
  declare template void CompleteOrthogonalDecomposition<MatrixXd>::computeInPlace();                                                       \
  declare template void CompleteOrthogonalDecomposition<MatrixXd>::_solve_impl<MatrixXd::IdentityReturnType, MatrixXd>(                    \
      const MatrixXd::IdentityReturnType&, MatrixXd&) const;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"  // a packet of doubles is a vector with one
namespace Eigen::internal {
using DoubleGebp = gebp_traits<double, double>;
LUMITEXEL_EIGEN_KERNELS(extern)
}  // namespace Eigen::internal
namespace Eigen {
using Matrix6d = Matrix<double, 6, 6>;
using Vector6d = Matrix<double, 6, 1>;
using Matrix8d = Matrix<double, 8, 8>;
using UpTo8x8 = Matrix<double, Dynamic, Dynamic, ColMajor, 8, 8>;
using UpTo8 = Matrix<double, Dynamic, 1, ColMajor, 8, 1>;
LUMITEXEL_EIGEN_DECOMPOSITIONS(extern)
}  // namespace Eigen
#pragma GCC diagnostic pop
#endif
