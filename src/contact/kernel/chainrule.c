/* From the numbers of a facet (kernelimpl.h) to the nodes of its result, by exact first derivatives: images follow the facet's lattice, its directions and the
   mortar vertex (R, few numbers each); directions the corners of the facets around (J); lattice and mortar nodes their masters. Forces at a held
   rim have derivatives by the images but none of their own. */
#include "kernelimpl.h"

/* ---- directions ---------------------------------------------------------------------------------------------------------------------- */

/* w->J[D nv][nn]: directions by the nodes of the result. */
static PetscErrorCode DirectionRows_Private(RayWork w, const ContactSurface *s, PetscInt facet, PetscBool held)
{
  const PetscInt nv = w->facet.nv, D = w->facet.D;

  PetscFunctionBegin;
  PetscCall(ArrayGrow(D * nv * w->nn, sizeof(PetscReal), &w->size_J, &w->J));
  PetscCall(PetscArrayzero(w->J, D * nv * w->nn));
  for (PetscInt v = 0; v < nv && !held; v++) PetscCall(ContactDirectionRows(w, s, ContactCorner(nv, facet, v), 1, &w->result, w->J + D * v * w->nn));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* H += second derivatives of sum_v gradient_v . d_v: of a facet's vector dd x de twice, d = x_2 - x_0, e = (x_3 - x_1) / 2. */
PetscErrorCode ContactRayDirectionCurvature(RayWork w, const ContactSurface *s, PetscInt facet, const PetscReal gradient[], PetscReal H[])
{
  const PetscInt na = w->facet.s.num, nn = w->nn;
  DirectionTerm  term[RAY_TERMS];

  PetscFunctionBegin;
  if (s->dim == 2) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = 0; v < 4; v++) {
    const PetscReal *along = gradient + 3 * (na + v);
    const PetscInt   terms = ContactDirectionTerms(w, s, ContactCorner(4, facet, v), term);

    for (PetscInt t = 0; t < terms; t++)
      for (int pair = 0; pair < 4; pair++) {
        const PetscInt  *node = s->facets + 4 * term[t].facet, *a = &node[pair % 2 ? 0 : 2], *b = &node[pair / 2 ? 1 : 3], *ma, *mb;
        const PetscReal *wa, *wb, sign = (pair % 2 ? -1 : 1) * (pair / 2 ? -0.5 : 0.5), *R = term[t].R;
        const PetscInt   masters_a = ContactNodeRow(s, a, &ma, &wa), masters_b = ContactNodeRow(s, b, &mb, &wb);
        PetscInt         pa, pb;

        for (PetscInt i = 0; i < masters_a; i++) {
          PetscCall(ContactResultNode(&w->result, ma[i], &pa));
          for (PetscInt j = 0; j < masters_b; j++) {
            const PetscReal f = sign * wa[i] * wb[j];

            PetscCall(ContactResultNode(&w->result, mb[j], &pb));
            for (int l = 0; l < 3; l++) { /* component l of the cross product */
              const PetscReal value = f * (along[0] * R[l] + along[1] * R[3 + l] + along[2] * R[6 + l]);
              const PetscInt  y = (l + 1) % 3, z = (l + 2) % 3;

              H[(3 * pa + y) * nn + 3 * pb + z] += value, H[(3 * pb + z) * nn + 3 * pa + y] += value;
              H[(3 * pa + z) * nn + 3 * pb + y] -= value, H[(3 * pb + y) * nn + 3 * pa + z] -= value;
            }
          }
        }
      }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- images -------------------------------------------------------------------------------------------------------------------------- */

/* Numbers of an image: those of lattice and directions, then the vertex's own. */
static inline PetscInt Width_Private(const RayFacet *f)
{
  return f->D * (f->s.num + f->nv + 1);
}

/* Place of the first number of image k's vertex, -1 where it has none of its own. */
static PetscInt Vertex_Private(RayWork w, PetscInt k)
{
  PetscInt at = 0;

  if (w->image[k].parent[0] >= 0) return -1;
  while (w->vertex[at] != w->image[k].node) at++;
  return w->facet.D * (w->facet.s.num + w->facet.nv + at);
}

PetscErrorCode ContactRayChain(RayWork w, const ContactSurface *nonmortar, PetscInt facet, PetscBool held)
{
  const RayFacet *f     = &w->facet;
  const PetscInt  width = Width_Private(f);

  PetscFunctionBegin;
  PetscCall(DirectionRows_Private(w, nonmortar, facet, held));
  PetscCall(ArrayGrow(f->m * w->num_images * width, sizeof(PetscReal), &w->size_R, &w->R));
  PetscCall(PetscArrayzero(w->R, f->m * w->num_images * width));
  for (PetscInt k = 0; k < w->num_images; k++)
    if (w->image[k].parent[0] < 0) ContactImageRows(f, &w->image[k], f->s.num + f->nv, width, w->R + f->m * k * width);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* W[D * own and vertices][num] += R^T X[m * images][num], rows ld apart */
static void FoldImages_Private(RayWork w, PetscInt num, const PetscReal X[], PetscInt ldx, PetscReal W[], PetscInt ldw)
{
  const RayFacet *f   = &w->facet;
  const PetscInt  own = f->D * (f->s.num + f->nv), width = Width_Private(f);

  ContactRayProducts(f->m * w->num_images, 1, own, w->R, width, num, X, ldx, W, ldw);
  for (PetscInt k = 0; k < w->num_images; k++) {
    const PetscInt at = Vertex_Private(w, k);

    for (PetscInt i = f->m * k; i < f->m * (k + 1) && at >= 0; i++)
      for (PetscInt c = 0; c < f->D; c++) {
        const PetscReal factor = w->R[i * width + own + c];

        for (PetscInt j = 0; j < num; j++) W[(at + c) * ldw + j] += factor * X[i * ldx + j];
      }
  }
}

/* ---- nodes --------------------------------------------------------------------------------------------------------------------------- */

/* Row of a lattice (v < na) or mortar node's first number. */
static inline PetscInt Row_Private(const RayFacet *f, PetscInt v)
{
  return f->D * (v < f->s.num ? v : v + f->nv);
}

void ContactRayChainImages(RayWork w, PetscInt num, PetscReal X[])
{
  const PetscInt nodes = w->facet.D * (w->facet.s.num + w->facet.nv + w->num_mortar);

  FoldImages_Private(w, num, X + nodes * num, num, X, num);
}

void ContactRayChainNodes(RayWork w, PetscInt num, const PetscReal X[], PetscReal to[])
{
  const RayFacet *f = &w->facet;
  const PetscInt  D = f->D, na = f->s.num, nn = w->nn;

  ContactRayProducts(D * f->nv, 1, num, X + D * na * num, num, nn, w->J, nn, to, nn);
  for (PetscInt v = 0; v < na + w->num_mortar; v++)
    for (PetscInt k = w->result.row_first[v]; k < w->result.row_first[v + 1]; k++)
      for (PetscInt c = 0; c < D; c++)
        for (PetscInt r = 0; r < num; r++) to[r * nn + D * w->result.row_node[k] + c] += w->result.row_weight[k] * X[(Row_Private(f, v) + c) * num + r];
}

PetscErrorCode ContactRayChainForces(RayWork w, PetscInt rows, PetscReal K[], PetscReal to[])
{
  const PetscInt n = w->n;
  PetscReal     *X;

  PetscFunctionBegin;
  ContactImagesFold(w, rows, K, n);
  PetscCall(PetscMalloc1(n * rows, &X));
  for (PetscInt i = 0; i < rows; i++)
    for (PetscInt j = 0; j < n; j++) X[j * rows + i] = K[i * n + j];
  ContactRayChainImages(w, rows, X);
  ContactRayChainNodes(w, rows, X, to);
  PetscCall(PetscFree(X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* to[D * masters] += row[D * nodes but directions] */
static void Scatter_Private(const RayWork w, PetscReal factor, const PetscReal row[], PetscReal to[])
{
  const RayFacet *f = &w->facet;
  const PetscInt  D = f->D;

  for (PetscInt v = 0; v < f->s.num + w->num_mortar; v++) {
    const PetscReal *from = row + Row_Private(f, v);

    for (PetscInt k = w->result.row_first[v]; k < w->result.row_first[v + 1]; k++)
      for (PetscInt c = 0; c < D; c++) to[D * w->result.row_node[k] + c] += factor * w->result.row_weight[k] * from[c];
  }
}

/* K[rows][nodes] = S_.n + S_.i R, S = W + W^T; work[images][rows]. */
static void ImagesFollow_Private(RayWork w, PetscInt rows, PetscInt nodes, PetscReal work[], PetscReal K[])
{
  const RayFacet  *f   = &w->facet;
  const PetscInt   own = f->D * (f->s.num + f->nv), n = w->n, width = Width_Private(f);
  const PetscReal *W = w->W;

  for (PetscInt i = 0; i < rows; i++)
    for (PetscInt j = 0; j < nodes; j++) K[i * nodes + j] = W[i * n + j] + W[j * n + i];
  for (PetscInt q = 0; q < n - nodes; q++)
    for (PetscInt i = 0; i < rows; i++) work[q * rows + i] = W[i * n + nodes + q] + W[(nodes + q) * n + i];
  ContactRayProducts(n - nodes, 1, rows, work, rows, own, w->R, width, K, nodes);
  for (PetscInt k = 0; k < w->num_images; k++) {
    const PetscInt at = Vertex_Private(w, k);

    for (PetscInt q = f->m * k; q < f->m * (k + 1) && at >= 0; q++)
      for (PetscInt i = 0; i < rows; i++)
        for (PetscInt c = 0; c < f->D; c++) K[i * nodes + at + c] += work[q * rows + i] * w->R[q * width + own + c];
  }
}

PetscErrorCode ContactRayChainHessian(RayWork w, PetscReal H[])
{
  const RayFacet *f = &w->facet;
  const PetscInt  D = f->D, na = f->s.num, nn = w->nn, nodes = D * (na + f->nv + w->num_mortar), mi = w->n - nodes, nd = D * f->nv;
  const PetscInt  rows = w->frozen ? nodes : w->n;
  PetscReal      *K, *B, *columns;

  PetscFunctionBegin;
  PetscCall(ArrayGrow(mi * rows + (rows + nn) * nodes + nd * nn, sizeof(PetscReal), &w->size_WJ, &w->WJ));
  K       = w->WJ + mi * rows;
  B       = K + rows * nodes;
  columns = B + nn * nodes;
  ImagesFollow_Private(w, rows, nodes, w->WJ, K);
  if (!w->frozen) FoldImages_Private(w, nodes, K + nodes * nodes, nodes, K, nodes);
  PetscCall(PetscArrayzero(B, nn * nodes));
  for (PetscInt v = 0; v < na + w->num_mortar; v++)
    for (PetscInt k = w->result.row_first[v]; k < w->result.row_first[v + 1]; k++)
      for (PetscInt c = 0; c < D; c++) {
        const PetscReal *from = K + (Row_Private(f, v) + c) * nodes;
        PetscReal       *to   = B + (D * w->result.row_node[k] + c) * nodes;

        for (PetscInt l = 0; l < nodes; l++) to[l] += w->result.row_weight[k] * from[l];
      }
  ContactRayProducts(nd, 1, nn, w->J, nn, nodes, K + D * na * nodes, nodes, B, nodes);
  for (PetscInt i = 0; i < nn; i++) Scatter_Private(w, 1, B + i * nodes, H + i * nn);
  for (PetscInt d = 0; d < nd; d++)
    for (PetscInt i = 0; i < nn; i++) columns[d * nn + i] = B[i * nodes + D * na + d];
  ContactRayProducts(nd, 1, nn, columns, nn, nn, w->J, nn, H, nn);
  for (PetscInt i = 0; i < nn && !w->frozen; i++) /* symmetric but for rounding */
    for (PetscInt j = 0; j < i; j++) H[i * nn + j] = H[j * nn + i] = 0.5 * (H[i * nn + j] + H[j * nn + i]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
