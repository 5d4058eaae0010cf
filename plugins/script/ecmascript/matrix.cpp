// matrix.cpp: Implements VrmlMatrix (C.6.19): 4 x 4, m[row][column], translation in the last row.
// SFMatrix4f and SFMatrix4d (ISO/IEC 19777-1) have the same methods. SFMatrix3f and SFMatrix3d are
// transformations of the plane; they are computed as those of space that leave z alone.
#include <cmath>
#include <cstring>
#include <iterator>

#include "slots.h"

namespace ecma {
namespace {

struct Matrix {
  double m[4][4];
};

constexpr Matrix identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

Matrix* matrixData(duk_context* ctx, duk_idx_t index) {
  if (!duk_is_object(ctx, index)) return nullptr;
  duk_get_prop_heapptr(ctx, index, Interpreter::of(ctx).keyMatrix);
  auto* data = static_cast<Matrix*>(duk_get_buffer(ctx, -1, nullptr));
  duk_pop(ctx);
  return data;
}

// A matrix of the program: a VrmlMatrix, or one of X3D's types.
struct Operand {
  Matrix m;
  XsType type;           // XS_TYPE_32_BITS: a VrmlMatrix
  Matrix* own = nullptr; // the data of a VrmlMatrix
  SfData* sf = nullptr;
  bool isVrml() const { return own != nullptr; }
  bool isPlane() const { return !own && components(type) == 9; }
  const char* name() const { return own ? "VrmlMatrix" : typeName(type); }
  // Returns the type of the vectors that it transforms.
  XsType vector() const {
    const bool doubles = !own && xsHasDoubles(type);
    if (isPlane()) return doubles ? XS_SFVEC2D : XS_SFVEC2F;
    return doubles ? XS_SFVEC3D : XS_SFVEC3F;
  }
};

// Rows and columns of a transformation of the plane in one of space.
constexpr int planeAxes[] = {0, 1, 3};

Matrix spaceOf(const double* v, int numbers) {
  Matrix m = identity;
  const int side = numbers == 9 ? 3 : 4;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      (side == 3 ? m.m[planeAxes[i]][planeAxes[j]] : m.m[i][j]) = v[side * i + j];
  return m;
}

void numbersOf(const Matrix& m, int numbers, double* v) {
  const int side = numbers == 9 ? 3 : 4;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      v[side * i + j] = side == 3 ? m.m[planeAxes[i]][planeAxes[j]] : m.m[i][j];
}

bool isMatrixType(XsType type) { return components(type) == 9 || components(type) == 16; }

bool readOperand(duk_context* ctx, duk_idx_t index, Operand& out) {
  if (Matrix* own = matrixData(ctx, index)) {
    out = {*own, XS_TYPE_32_BITS, own, nullptr};
    return true;
  }
  SfData* sf = sfData(ctx, index);
  if (!sf || !isMatrixType(sf->type)) return false;
  out = {spaceOf(sf->v, components(sf->type)), sf->type, nullptr, sf};
  return true;
}

// Leaves the receiver at index `this` on top of the stack.
Operand receiver(duk_context* ctx) {
  step(Interpreter::of(ctx));
  duk_push_this(ctx);
  Operand operand;
  if (!readOperand(ctx, -1, operand)) throwType(ctx, "must be called on a matrix");
  return operand;
}

void store(duk_context* ctx, duk_idx_t index, const Operand& to, const Matrix& value) {
  if (to.isVrml()) {
    *to.own = value;
    return;
  }
  numbersOf(value, components(to.type), to.sf->v);
  writeBack(ctx, Interpreter::of(ctx), index, to.sf, 0, components(to.type));
}

duk_ret_t answerVrml(duk_context* ctx, const Matrix& value) {
  Interpreter& self = Interpreter::of(ctx);
  duk_push_bare_object(ctx);
  duk_push_heapptr(ctx, self.matrixPrototype);
  duk_set_prototype(ctx, -2);
  *static_cast<Matrix*>(duk_push_fixed_buffer(ctx, sizeof(Matrix))) = value;
  duk_put_prop_heapptr(ctx, -2, self.keyMatrix);
  return 1;
}

// Returns a new matrix of the receiver's type.
duk_ret_t answer(duk_context* ctx, const Operand& like, const Matrix& value) {
  if (like.isVrml()) return answerVrml(ctx, value);
  double v[XS_MOST_COMPONENTS];
  numbersOf(value, components(like.type), v);
  pushSf(ctx, Interpreter::of(ctx), like.type, v);
  return 1;
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k) c.m[i][j] += a.m[i][k] * b.m[k][j];
  return c;
}

Matrix translation(const double* t, double sign) {
  Matrix a = identity;
  for (int i = 0; i < 3; ++i) a.m[3][i] = sign * t[i];
  return a;
}

// Returns the transpose of Rodrigues' matrix, for row vectors.
Matrix rotation(const double* r, double sign) {
  const double length = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
  if (!(length > 0)) return identity;
  const double x = r[0] / length, y = r[1] / length, z = r[2] / length, s = std::sin(sign * r[3]),
               c = std::cos(r[3]), t = 1 - c;
  return {{{t * x * x + c, t * x * y + s * z, t * x * z - s * y, 0},
           {t * x * y - s * z, t * y * y + c, t * y * z + s * x, 0},
           {t * x * z + s * y, t * y * z - s * x, t * z * z + c, 0},
           {0, 0, 0, 1}}};
}

// Reads an argument that may be missing or null.
bool optional(duk_context* ctx, duk_idx_t index, XsType type, double* out) {
  if (duk_is_null_or_undefined(ctx, index)) return false;
  toPlain(ctx, index, type, out, "setTransform");
  return true;
}

// Reads a rotation: in the plane an angle about z, where an SFRotation will do, too.
void optionalRotation(duk_context* ctx, duk_idx_t index, bool plane, double* out) {
  if (plane && duk_is_number(ctx, index))
    out[3] = duk_get_number(ctx, index);
  else
    optional(ctx, index, XS_SFROTATION, out);
}

// Sets the matrix of a Transform (6.52) with these fields.
// arguments: translation, rotation, scale, scaleOrientation, center
duk_ret_t setTransform(duk_context* ctx) {
  const Operand to = receiver(ctx);
  const duk_idx_t self = duk_get_top_index(ctx);
  double t[4] = {}, r[4] = {0, 0, 1, 0}, s[4] = {1, 1, 1, 0}, o[4] = {0, 0, 1, 0}, c[4] = {};
  optional(ctx, 0, to.vector(), t);
  optionalRotation(ctx, 1, to.isPlane(), r);
  optional(ctx, 2, to.vector(), s);
  optionalRotation(ctx, 3, to.isPlane(), o);
  optional(ctx, 4, to.vector(), c);
  Matrix scale = identity;
  for (int i = 0; i < 3; ++i) scale.m[i][i] = s[i];
  Matrix all = product(translation(c, -1), rotation(o, -1));
  all = product(product(all, scale), rotation(o, 1));
  all = product(product(all, rotation(r, 1)), translation(c, 1));
  store(ctx, self, to, product(all, translation(t, 1)));
  return 0;
}

bool invert(const Matrix& from, Matrix& out) { // Gauss-Jordan elimination with pivoting
  Matrix a = from;
  out = identity;
  for (int column = 0; column < 4; ++column) {
    int pivot = column;
    for (int i = column + 1; i < 4; ++i)
      if (std::fabs(a.m[i][column]) > std::fabs(a.m[pivot][column])) pivot = i;
    if (!(std::fabs(a.m[pivot][column]) > 1e-300)) return false;
    std::swap(a.m[pivot], a.m[column]);
    std::swap(out.m[pivot], out.m[column]);
    const double scale = 1 / a.m[column][column];
    for (int j = 0; j < 4; ++j) {
      a.m[column][j] *= scale;
      out.m[column][j] *= scale;
    }
    for (int i = 0; i < 4; ++i) {
      const double factor = i == column ? 0 : a.m[i][column];
      for (int j = 0; j < 4; ++j) {
        a.m[i][j] -= factor * a.m[column][j];
        out.m[i][j] -= factor * out.m[column][j];
      }
    }
  }
  return true;
}

Matrix transposed(const Matrix& a) {
  Matrix b;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) b.m[i][j] = a.m[j][i];
  return b;
}

// Returns the rotation nearest to a matrix: N. Higham, "Computing the polar decomposition", 1986.
Matrix nearestRotation(const Matrix& linear) {
  Matrix q = linear;
  constexpr int rounds = 60;
  for (int i = 0; i < rounds; ++i) {
    Matrix inverse;
    if (!invert(q, inverse)) return identity;
    double change = 0;
    for (int row = 0; row < 3; ++row)
      for (int k = 0; k < 3; ++k) {
        const double next = 0.5 * (q.m[row][k] + inverse.m[k][row]);
        change += std::fabs(next - q.m[row][k]);
        q.m[row][k] = next;
      }
    if (change < 1e-14) break;
  }
  const double det = q.m[0][0] * (q.m[1][1] * q.m[2][2] - q.m[1][2] * q.m[2][1]) -
                     q.m[0][1] * (q.m[1][0] * q.m[2][2] - q.m[1][2] * q.m[2][0]) +
                     q.m[0][2] * (q.m[1][0] * q.m[2][1] - q.m[1][1] * q.m[2][0]);
  if (det < 0)
    for (auto& row : q.m)
      for (int k = 0; k < 3; ++k) row[k] = -row[k];
  return q;
}

// Computes axis and angle of a rotation matrix for row vectors.
void axisOf(const Matrix& q, double* r) {
  const double x = q.m[1][2] - q.m[2][1], y = q.m[2][0] - q.m[0][2], z = q.m[0][1] - q.m[1][0];
  const double sine = std::sqrt(x * x + y * y + z * z), trace = q.m[0][0] + q.m[1][1] + q.m[2][2];
  r[0] = 0;
  r[1] = 0;
  r[2] = 1;
  r[3] = 0;
  if (sine > 1e-9) {
    r[0] = x / sine;
    r[1] = y / sine;
    r[2] = z / sine;
    r[3] = std::atan2(sine, trace - 1);
  } else if (trace < 0) { // half a turn: the columns of q + 1 are parallel to the axis
    int k = 0;
    for (int i = 1; i < 3; ++i)
      if (q.m[i][i] > q.m[k][k]) k = i;
    double length = 0;
    for (int i = 0; i < 3; ++i) {
      r[i] = q.m[k][i] + (i == k ? 1 : 0);
      length += r[i] * r[i];
    }
    for (int i = 0; i < 3; ++i) r[i] /= std::sqrt(length);
    r[3] = std::acos(-1.0);
  }
}

// Writes numbers into an object of the program that has as many.
void give(duk_context* ctx, duk_idx_t index, XsType type, const double* v) {
  if (duk_is_null_or_undefined(ctx, index)) return;
  SfData* sf = sfData(ctx, index);
  const int count = components(type);
  const bool fits =
      sf && (type == XS_SFROTATION ? sf->type == type : components(sf->type) == count);
  if (!fits)
    throwType(ctx, "getTransform: expected %s, got %s", typeName(type), describe(ctx, index));
  std::memcpy(sf->v, v, size_t(count) * sizeof *v);
  writeBack(ctx, Interpreter::of(ctx), index, sf, 0, count);
}

// arguments: objects that receive translation, rotation, scale
duk_ret_t getTransform(duk_context* ctx) {
  const Operand of = receiver(ctx);
  const Matrix& m = of.m;
  Matrix linear = m;
  for (int i = 0; i < 3; ++i) linear.m[i][3] = linear.m[3][i] = 0;
  linear.m[3][3] = 1;
  const Matrix q = nearestRotation(linear), stretch = product(linear, transposed(q));
  const double t[4] = {m.m[3][0], m.m[3][1], m.m[3][2], 0},
               s[4] = {stretch.m[0][0], stretch.m[1][1], stretch.m[2][2], 0};
  double r[4];
  axisOf(q, r);
  give(ctx, 0, of.vector(), t);
  give(ctx, 1, XS_SFROTATION, r);
  give(ctx, 2, of.vector(), s);
  return 0;
}

duk_ret_t inverse(duk_context* ctx) {
  const Operand of = receiver(ctx);
  Matrix out;
  if (!invert(of.m, out)) throwRange(ctx, "%s.inverse: the matrix is singular", of.name());
  return answer(ctx, of, out);
}
duk_ret_t transpose(duk_context* ctx) {
  const Operand of = receiver(ctx);
  return answer(ctx, of, transposed(of.m));
}

// Reads the first argument, a matrix of as many rows as the receiver.
Matrix argument(duk_context* ctx, const Operand& like) {
  Operand other;
  if (!readOperand(ctx, 0, other) || other.isPlane() != like.isPlane())
    throwType(ctx, "expected %s, got %s", like.name(), describe(ctx, 0));
  return other.m;
}
duk_ret_t multLeft(duk_context* ctx) {
  const Operand of = receiver(ctx);
  return answer(ctx, of, product(argument(ctx, of), of.m));
}
duk_ret_t multRight(duk_context* ctx) {
  const Operand of = receiver(ctx);
  return answer(ctx, of, product(of.m, argument(ctx, of)));
}

duk_ret_t multiplied(duk_context* ctx, const Operand& of, const Matrix& m) {
  double v[4] = {}, out[4] = {};
  toPlain(ctx, 0, of.vector(), v, of.name());
  v[3] = 1;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) out[j] += v[i] * m.m[i][j];
  for (int j = 0; j < 3 && out[3] != 0; ++j) out[j] /= out[3];
  pushSf(ctx, Interpreter::of(ctx), of.vector(), out);
  return 1;
}
// Multiplies a row vector by the matrix.
duk_ret_t multVecMatrix(duk_context* ctx) {
  const Operand of = receiver(ctx);
  return multiplied(ctx, of, of.m);
}
// Multiplies the matrix by a column vector.
duk_ret_t multMatrixVec(duk_context* ctx) {
  const Operand of = receiver(ctx);
  return multiplied(ctx, of, transposed(of.m));
}

duk_ret_t toText(duk_context* ctx) {
  const Matrix m = receiver(ctx).m;
  char text[16 * 40];
  size_t length = 0;
  for (int i = 0; i < 16; ++i) {
    if (i > 0) text[length++] = ' ';
    length += printFloat(text + length, sizeof text - length, m.m[i / 4][i % 4]);
  }
  duk_push_lstring(ctx, text, length);
  return 1;
}

// --- m[i] is a view of the row, m[i][j] a number in it ---

duk_ret_t getRow(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  duk_push_this(ctx);
  if (!matrixData(ctx, -1)) return 0;
  duk_push_bare_object(ctx);
  duk_push_heapptr(ctx, self.rowPrototype);
  duk_set_prototype(ctx, -2);
  duk_get_prop_heapptr(ctx, -2, self.keyMatrix);
  duk_put_prop_heapptr(ctx, -2, self.keyMatrix);
  duk_push_int(ctx, duk_get_current_magic(ctx));
  duk_put_prop_heapptr(ctx, -2, self.keyRow);
  return 1;
}
duk_ret_t setRow(duk_context* ctx) {
  duk_push_this(ctx);
  Matrix* m = matrixData(ctx, -1);
  double v[4];
  if (!m) return 0;
  toPlain(ctx, 0, XS_SFROTATION, v, "a row of VrmlMatrix"); // reads four numbers
  std::memcpy(m->m[duk_get_current_magic(ctx)], v, sizeof v);
  return 0;
}
double* element(duk_context* ctx) {
  step(Interpreter::of(ctx));
  duk_push_this(ctx);
  Matrix* m = matrixData(ctx, -1);
  if (!m) return nullptr;
  duk_get_prop_heapptr(ctx, -1, Interpreter::of(ctx).keyRow);
  const unsigned row = duk_get_uint_default(ctx, -1, 0) & 3;
  return &m->m[row][duk_get_current_magic(ctx)];
}
duk_ret_t getElement(duk_context* ctx) {
  const double* number = element(ctx);
  if (!number) return 0;
  duk_push_number(ctx, *number);
  return 1;
}
duk_ret_t setElementOf(duk_context* ctx) {
  if (double* number = element(ctx)) *number = toNumber(ctx, 0, XS_SFFLOAT, "VrmlMatrix");
  return 0;
}

duk_ret_t construct(duk_context* ctx) { // arguments: 16 numbers row by row, another matrix, or none
  step(Interpreter::of(ctx));
  Matrix m = identity;
  const duk_idx_t given = duk_get_top(ctx);
  if (given == 1) return answerVrml(ctx, argument(ctx, {identity, XS_SFMATRIX4D}));
  if (given > 0 && given != 16)
    throwType(ctx, "VrmlMatrix: expected 16 numbers, got %d", int(given));
  for (int i = 0; i < given; ++i) m.m[i / 4][i % 4] = toNumber(ctx, i, XS_SFFLOAT, "VrmlMatrix");
  return answerVrml(ctx, m);
}

constexpr Method matrixMethods[] = {{"setTransform", setTransform, 5},
                                    {"getTransform", getTransform, 3},
                                    {"inverse", inverse, 0},
                                    {"transpose", transpose, 0},
                                    {"multLeft", multLeft, 1},
                                    {"multRight", multRight, 1},
                                    {"multVecMatrix", multVecMatrix, 1},
                                    {"multMatrixVec", multMatrixVec, 1}};

} // namespace

void registerMatrix(duk_context* ctx, Interpreter& self) {
  static constexpr Method text[] = {{"toString", toText, 0}};
  static const char* const indices[] = {"0", "1", "2", "3"};
  duk_push_bare_object(ctx);
  for (int i = 0; i < 4; ++i) putAccessor(ctx, indices[i], getElement, setElementOf, i);
  self.rowPrototype = keep(ctx);
  duk_push_object(ctx);
  for (int i = 0; i < 4; ++i) putAccessor(ctx, indices[i], getRow, setRow, i);
  putMethods(ctx, matrixMethods, std::size(matrixMethods));
  putMethods(ctx, text, std::size(text));
  duk_dup(ctx, -1);
  self.matrixPrototype = keep(ctx);
  putConstructor(ctx, "VrmlMatrix", construct, 0, "vrmlMatrix");
  for (const XsType type : {XS_SFMATRIX3F, XS_SFMATRIX3D, XS_SFMATRIX4F, XS_SFMATRIX4D}) {
    duk_push_heapptr(ctx, self.prototypes[type]);
    putMethods(ctx, matrixMethods, std::size(matrixMethods));
    duk_pop(ctx);
  }
}

} // namespace ecma
