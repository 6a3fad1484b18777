#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "arcslip/sectors/matrix_market.hpp"
#include "catch.hpp"

using namespace arcslip;

namespace {

const std::string banner = "%%MatrixMarket matrix coordinate real general\n";

Matrix dense(const SparseMatrix& matrix) { return Matrix(matrix); }

/// What the reader says of `text`; "" where it takes it.
std::string refusal(const std::string& text) {
  try {
    read_matrix_market(text, "K.mtx");
  } catch (const MatrixTextError& error) {
    return error.what();
  }
  return "";
}

SparseMatrix random_matrix(Index size, int entries, std::mt19937& random, bool symmetric) {
  std::uniform_int_distribution<int> index(0, static_cast<int>(size) - 1);
  std::normal_distribution<double> number;
  std::vector<Eigen::Triplet<double>> triplets;
  for (int k = 0; k < entries; ++k) {
    const int i = index(random);
    const int j = index(random);
    const double value = number(random) * std::exp(20 * number(random));
    triplets.emplace_back(i, j, value);
    if (symmetric && i != j) triplets.emplace_back(j, i, value);
  }
  SparseMatrix matrix(size, size);
  // The last of several is kept, so that both triangles are equal to the last digit.
  matrix.setFromTriplets(triplets.begin(), triplets.end(), [](double, double b) { return b; });
  return matrix;
}

/// Most memory that the program has had, in bytes.
double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// A text near one that is right: cut, with other bytes, with pieces of itself elsewhere, with hostile words.
std::string mutated(std::string text, std::mt19937& random) {
  const std::vector<std::string> words{"2147483647",
                                       "2147483648",
                                       "99999999999999999999",
                                       "-1",
                                       "0",
                                       "nan",
                                       "inf",
                                       "-inf",
                                       "1e400",
                                       "1d5",
                                       "+",
                                       "+-1",
                                       "\r\n",
                                       "\n\n\n",
                                       "%",
                                       "\t",
                                       " ",
                                       "1e",
                                       "0x1p3",
                                       "%%MatrixMarket",
                                       "symmetric",
                                       "complex",
                                       "500000",
                                       std::string(1, '\0'),
                                       std::string(500, '9')};
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n)(random); };
  for (std::size_t changes = below(3) + 1; changes > 0; --changes) {
    const std::size_t at = below(text.size());
    switch (below(4)) {
      case 0: text.resize(at); break;
      case 1: text.insert(at, words[below(words.size() - 1)]); break;
      case 2: text.replace(at, below(8), words[below(words.size() - 1)]); break;
      case 3: text.insert(at, text.substr(below(text.size()), below(40))); break;
      default:
        if (at < text.size()) text[at] = static_cast<char>(below(255));
    }
  }
  return text;
}

TEST_CASE("A gyroscopic matrix is read as it is, skew-symmetric, or as the Hermitian jG") {
  const Matrix wanted = (Matrix(3, 3) << 0, -2.5, 0, 2.5, 0, 4, 0, -4, 0).finished();
  const std::string entries = "3 3 2\n2 1 2.5\n3 2 -4\n";
  CHECK(dense(read_gyroscopic("%%MatrixMarket matrix coordinate real skew-symmetric\n" + entries, "G")) ==
        wanted);
  CHECK(dense(read_gyroscopic("%%MatrixMarket matrix coordinate real general\n3 3 4\n2 1 2.5\n3 2 -4\n"
                              "1 2 -2.5\n2 3 4\n",
                              "G")) == wanted);
  const std::string hermitian = "%%MatrixMarket matrix coordinate complex Hermitian\n3 3 2\n";
  CHECK(dense(read_gyroscopic(hermitian + "2 1 0 2.5\n3 2 0 -4\n", "G")) == wanted);
  CHECK_THROWS_WITH(
      read_gyroscopic(hermitian + "2 1 1 2.5\n3 2 0 -4\n", "G.mtx"),
      ContainsSubstring("G.mtx:3: expected a real part that is 0") && ContainsSubstring("got 1"));
  CHECK_THROWS_WITH(read_gyroscopic(hermitian + "2 1 0 2.5\n3 3 0 -4\n", "G.mtx"),
                    ContainsSubstring("no imaginary parts on the diagonal"));
  CHECK_THROWS_WITH(read_matrix_market(hermitian + "2 1 0 2.5\n3 2 0 -4\n", "K.mtx"),
                    ContainsSubstring("an imaginary part that is 0"));
}

TEST_CASE("Dense, skew-symmetric and complex matrices are the same as sparse real ones") {
  const auto read = [](const std::string& kind, const std::string& rest) {
    return Matrix(read_matrix_market("%%MatrixMarket matrix " + kind + "\n" + rest, "K.mtx"));
  };
  Matrix symmetric(2, 2);
  symmetric << 2, -1, -1, 0;
  CHECK(read("array real general", "2 2\n2\n-1\n-1\n0\n") == symmetric);
  CHECK(read("array real general", "2 2\n2 -1\n-1 0\n") == symmetric);
  CHECK(read("array integer symmetric", "2 2\n2\n-1\n0\n") == symmetric);
  CHECK(read("array complex hermitian", "2 2\n2 0\n-1 0\n0 0\n") == symmetric);
  CHECK(read("coordinate complex general", "2 2 3\n1 1 2 0\n1 2 -1 0\n2 1 -1 0\n") == symmetric);
  Matrix skew(2, 2);
  skew << 0, -3, 3, 0;
  CHECK(read("coordinate real skew-symmetric", "2 2 1\n2 1 3\n") == skew);
  CHECK(read("array real skew-symmetric", "2 2\n3\n") == skew);
  const SparseMatrix dense =
      read_matrix_market("%%MatrixMarket matrix array real symmetric\n2 2\n1\n0\n0\n", "K.mtx");
  CHECK(dense.nonZeros() == 2);  // the diagonal, which a structure must have, and no other zero
}

}  // namespace

TEST_CASE("A general matrix is read with comments, blank lines, carriage returns and no last newline") {
  Matrix expected(3, 3);
  expected << 1.5, 0, -2e-3, 0, 0, 0, 7, 0, 4;
  const std::string text =
      "%%MatrixMarket MATRIX Coordinate Real General\r\n% a comment\r\n\r\n 3 3\t4\r\n"
      "1 1 1.5\r\n%another\r\n  3 1 +7 % why not\n\n1 3 -2.0D-03\n3 3 4";
  const SparseMatrix matrix = read_matrix_market(text, "K.mtx");
  CHECK(dense(matrix) == expected);
  CHECK(matrix.isCompressed());
}

TEST_CASE("A symmetric matrix is given by its lower triangle, and integers are numbers") {
  Matrix expected(2, 2);
  expected << 2, -1, -1, 3;
  const SparseMatrix matrix = read_matrix_market(
      "%%MatrixMarket matrix coordinate integer symmetric\n2 2 3\n1 1 2\n2 1 -1\n2 2 3\n", "M.mtx");
  CHECK(dense(matrix) == expected);
  CHECK(matrix.isCompressed());
}

TEST_CASE("Entries given more than once are summed") {
  const SparseMatrix matrix = read_matrix_market(banner + "2 2 4\n1 2 1\n2 2 5\n1 2 2\n1 2 4\n", "K.mtx");
  CHECK(matrix.nonZeros() == 2);
  CHECK(matrix.coeff(0, 1) == 7);
  const SparseMatrix symmetric = read_matrix_market(
      "%%MatrixMarket matrix coordinate real symmetric\n2 2 4\n2 1 1\n2 1 2\n1 1 3\n1 1 4\n", "K.mtx");
  CHECK(symmetric.coeff(0, 1) == 3);
  CHECK(symmetric.coeff(1, 0) == 3);
  CHECK(symmetric.coeff(0, 0) == 7);
}

TEST_CASE("What is not such a matrix is refused with file, line, what was expected and what was given") {
  struct Example {
    std::string text;
    const char* message;
  };
  const std::string symmetric = "%%MatrixMarket matrix coordinate real symmetric\n";
  const Example example = GENERATE_COPY(values<Example>({
      {"", "K.mtx:1: expected a line that begins with %%MatrixMarket, got an empty file"},
      {"3 3 1\n1 1 1\n", "K.mtx:1: expected a Matrix Market file, which begins with %%matrixmarket, got '3'"},
      {"%%MatrixMarket vector\n", "K.mtx:1: expected the object matrix, got 'vector'"},
      {"%%MatrixMarket matrix dense real general\n",
       "K.mtx:1: expected the format coordinate or array, got 'dense'"},
      {"%%MatrixMarket matrix coordinate pattern general\n",
       "K.mtx:1: expected values that are real or integer or complex, got 'pattern'"},
      {"%%MatrixMarket matrix coordinate real triangular\n",
       "K.mtx:1: expected a matrix that is general or symmetric or skew-symmetric or hermitian, got "
       "'triangular'"},
      {"%%MatrixMarket matrix coordinate real",
       "K.mtx:1: expected a matrix that is general or symmetric or skew-symmetric or hermitian, got the end "
       "of the line"},
      {"%%MatrixMarket matrix coordinate complex hermitian\n1 1 1\n1 1 2 0.5\n",
       "K.mtx:3: expected an imaginary part that is 0, as M, C and K are real (structural damping is "
       "damping_kind, a wave is wave_number), got 0.5"},
      {"%%MatrixMarket matrix coordinate real skew-symmetric\n2 2 1\n2 2 1\n",
       "K.mtx:3: expected what is below the diagonal of a skew-symmetric matrix, got row 2, column 2"},
      {"%%MatrixMarket matrix array real general\n",
       "K.mtx:1: expected the numbers of rows and columns, got "
       "the end of the file"},
      {"%%MatrixMarket matrix array real general\n2 2\n1.0\n2.0\n3.0\n",
       "K.mtx:5: expected 4 entries, got 3"},
      {"%%MatrixMarket matrix array real symmetric\n2 2\n1\n2\n3\n4\n",
       "K.mtx:6: expected no more than the 3 entries of the sizes, got '4'"},
      {"%%MatrixMarket matrix array real general\n1000 1000\n1\n",
       "K.mtx:2: expected at most the 1 entries that the rest of the file has room for, got 1000000"},
      {banner, "K.mtx:1: expected the numbers of rows, columns and entries, got the end of the file"},
      {banner + "3 3\n",
       "K.mtx:2: expected a number of entries from 0 to 2147483647, got the end of the line"},
      {banner + "-3 3 1\n", "K.mtx:2: expected a number of rows from 1 to 2147483647, got '-3'"},
      {banner + "3 2147483648 1\n",
       "K.mtx:2: expected a number of columns from 1 to 2147483647, got '2147483648'"},
      {banner + "3 2 1\n1 1 1\n", "K.mtx:2: expected a square matrix, got 3 rows and 2 columns"},
      {banner + "3 3 3\n1 1 1\n2 2 2\n",
       "K.mtx:2: expected at most the 2 entries that the rest of the file has room for, got 3"},
      {banner + "2000000000 2000000000 0\n",
       "K.mtx:2: expected at most 524288 rows for 0 entries, got 2000000000"},
      {banner + "3 3 1\n1 4 1\n", "K.mtx:3: expected a column from 1 to 3, got '4'"},
      {banner + "3 3 1\n0 1 1\n", "K.mtx:3: expected a row from 1 to 3, got '0'"},
      {banner + "3 3 1\n1.0 1 1\n", "K.mtx:3: expected a row from 1 to 3, got '1.0'"},
      {banner + "3 3 1\n1 1\n    ", "K.mtx:3: expected a finite number, got the end of the line"},
      {banner + "3 3 1\n1 1 nan\n", "K.mtx:3: expected a finite number, got 'nan'"},
      {banner + "3 3 1\n1 1 1e400\n", "K.mtx:3: expected a finite number, got '1e400'"},
      {banner + "3 3 1\n1 1 1.0 0.0\n", "K.mtx:3: expected the end of the line after the value, got '0.0'"},
      {banner + "3 3 1\n1 1 1\n\n2 2 2\n",
       "K.mtx:5: expected no more than the 1 entries of the sizes, got '2 2 2'"},
      {banner + "3 3 2\n1 1 1.000000\n", "K.mtx:3: expected 2 entries, got 1"},
      {symmetric + "3 3 1\n1 2 1\n",
       "K.mtx:3: expected the lower triangle of a symmetric matrix, got row 1, column 2"},
      {banner + "1 1 2\n1 1 1e308\n1 1 1e308\n",
       "K.mtx:4: expected entries given twice to have a finite sum, got infinity"},
  }));
  CHECK(refusal(example.text) == example.message);
}

TEST_CASE("What an error quotes stays on one line, and short") {
  const std::string message = refusal(banner + "3 3 1\n1 1 \x1b" + std::string(1000, 'x') + "\n");
  CHECK(message == "K.mtx:3: expected a finite number, got '?" + std::string(39, 'x') + "...'");
}

TEST_CASE("What is written is read as it was, to the last digit") {
  std::mt19937 random(5);
  for (int i = 0; i < 100; ++i) {
    const bool symmetric = i % 2 == 1;
    const SparseMatrix matrix = random_matrix(1 + i, 3 * i, random, symmetric);
    const std::string text =
        write_matrix_market(matrix, symmetric ? MatrixSymmetry::symmetric : MatrixSymmetry::general);
    const SparseMatrix again = read_matrix_market(text, "K.mtx");
    REQUIRE(again.nonZeros() == matrix.nonZeros());
    REQUIRE(dense(again) == dense(matrix));
  }
  SparseMatrix skew(2, 2);
  skew.insert(0, 1) = 1;
  CHECK_THROWS_AS(write_matrix_market(skew, MatrixSymmetry::symmetric), std::invalid_argument);
}

TEST_CASE("Twenty thousand broken texts neither crash nor take more memory than theirs and 16 MiB") {
  std::mt19937 random(11);
  std::vector<std::string> right;
  for (int i = 0; i < 20; ++i) {
    const bool symmetric = i % 2 == 1;
    right.push_back(write_matrix_market(random_matrix(1 + i, 2 * i, random, symmetric),
                                        symmetric ? MatrixSymmetry::symmetric : MatrixSymmetry::general));
  }
  const double before = peak_memory();
  read_matrix_market("%%MatrixMarket matrix coordinate real symmetric\n524289 524289 1\n1 1 1\n", "K.mtx");
  int refused = 0;
  int wrong = 0;
  for (std::size_t i = 0; i < 20000; ++i) {
    const std::string text = mutated(right[i % right.size()], random);
    try {
      const SparseMatrix matrix = read_matrix_market(text, "K.mtx");
      if (!matrix.isCompressed() || !matrix.coeffs().allFinite()) ++wrong;
    } catch (const MatrixTextError& error) {
      ++refused;
      const std::string message = error.what();
      if (!message.starts_with("K.mtx:") || message.size() > 300 || message.find('\n') != message.npos)
        ++wrong;
    }
  }
  CHECK(wrong == 0);
  CHECK(refused > 10000);  // most mutations break something
  CHECK(refused < 20000);
#ifdef __SANITIZE_ADDRESS__
  constexpr double held_back = 512e6;  // the sanitizer keeps what is freed
#else
  constexpr double held_back = 4e6;  // pieces that the allocator keeps
#endif
  CHECK(peak_memory() - before < 16 * 1048576.0 + held_back);
}

TEST_CASE("Lists of dofs are read from 1, a line or a blank between them") {
  CHECK(read_dofs("1 2\n\n# contacts\n 7\t9\r\n+3 % the rim\n10", "left.txt", 10) ==
        std::vector<Index>{0, 1, 6, 8, 2, 9});
  CHECK(read_dofs("", "left.txt", 10).empty());
  CHECK_THROWS_WITH(read_dofs("1\n2 11\n", "left.txt", 10),
                    "left.txt:2: expected a dof from 1 to 10, got '11'");
  CHECK_THROWS_WITH(read_dofs("1,2", "left.txt", 10), "left.txt:1: expected a dof from 1 to 10, got '1,2'");
  CHECK_THROWS_AS(read_dofs("99999999999999999999", "left.txt", 10), MatrixTextError);
}
