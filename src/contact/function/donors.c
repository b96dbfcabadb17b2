/* Pressure at nodes that carry no multiplier. Their functions went to others of their facets, psi_j += l_j(X_e) psi_e (dual.c), so the pressure that acts
   there is z_e = sum_j l_j(X_e) z_j; where facets around the node say different things, their mean. */
#include "functionimpl.h"

PetscErrorCode ContactDonorsKeep(MultiplierDonors *d, PetscInt n, const PetscInt node[], const PetscBool carries[], const PetscReal W[])
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(d->to, d->from, d->weight));
  PetscCall(PetscMalloc3(n * n, &d->to, n * n, &d->from, n * n, &d->weight));
  d->num = 0;
  for (PetscInt e = 0; e < n; e++)
    for (PetscInt j = 0; j < n && !carries[e]; j++) {
      if (!carries[j] || W[n * e + j] == 0) continue;
      d->to[d->num]       = node[e];
      d->from[d->num]     = node[j];
      d->weight[d->num++] = W[n * e + j];
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* mean[n] = 1 / number of groups of facets that say what the pressure at n is; first[n + 1] += all they say. Entries of a node stand together. */
static void Count_Private(const MultiplierWork *w, PetscReal mean[], PetscInt first[])
{
  const PetscInt num_nodes = w->s->num_nodes;

  for (PetscInt f = 0; f < w->s->num_facets; f++) {
    const MultiplierDonors *d = w->donors + f;

    for (PetscInt i = 0; i < d->num; i++) {
      first[d->to[i] + 1]++;
      if (i == 0 || d->to[i] != d->to[i - 1]) mean[d->to[i]]++;
    }
  }
  for (PetscInt n = 0; n < num_nodes; n++) {
    first[n + 1] += first[n];
    if (mean[n] > 0) mean[n] = 1 / mean[n];
  }
}

/* Sorts each node's donors and adds up those that stand there more than once. */
static PetscErrorCode Merge_Private(PetscInt num_nodes, ContactMultiplier *m)
{
  PetscInt at = 0, begin = 0;

  PetscFunctionBegin;
  for (PetscInt n = 0; n < num_nodes; n++) {
    const PetscInt end = m->donor_first[n + 1], start = at;

    PetscCall(PetscSortIntWithScalarArray(end - begin, m->donor + begin, m->donor_weight + begin));
    for (PetscInt i = begin; i < end; i++) {
      if (at > start && m->donor[at - 1] == m->donor[i]) {
        m->donor_weight[at - 1] += m->donor_weight[i];
        continue;
      }
      m->donor[at]          = m->donor[i];
      m->donor_weight[at++] = m->donor_weight[i];
    }
    begin                 = end;
    m->donor_first[n + 1] = at;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactDonorsPack(const MultiplierWork *w, ContactMultiplier *m)
{
  const PetscInt num_nodes = w->s->num_nodes;
  PetscReal     *mean;
  PetscInt      *next;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(num_nodes + 1, &m->donor_first));
  PetscCall(PetscCalloc1(num_nodes, &mean));
  PetscCall(PetscMalloc1(num_nodes + 1, &next));
  Count_Private(w, mean, m->donor_first);
  PetscCall(PetscArraycpy(next, m->donor_first, num_nodes + 1));
  PetscCall(PetscMalloc2(next[num_nodes], &m->donor, next[num_nodes], &m->donor_weight));
  for (PetscInt f = 0; f < w->s->num_facets; f++) {
    const MultiplierDonors *d = w->donors + f;

    for (PetscInt i = 0; i < d->num; i++) {
      m->donor[next[d->to[i]]]          = d->from[i];
      m->donor_weight[next[d->to[i]]++] = mean[d->to[i]] * d->weight[i];
    }
  }
  PetscCall(Merge_Private(num_nodes, m));
  PetscCall(PetscFree(mean));
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ContactPairGetDonors(ContactPair pair, const PetscInt **first, const PetscInt **donor, const PetscReal **weight)
{
  const ContactMultiplier *m = pair->multiplier;

  *first  = m ? m->donor_first : NULL;
  *donor  = m ? m->donor : NULL;
  *weight = m ? m->donor_weight : NULL;
}
