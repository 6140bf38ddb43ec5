/* All of MPI and MUMPS that the crate calls. Layouts of structs stay on this side.
 *
 * Instances stand in a table and go by their place in it. Every rank makes and frees them in the same
 * order, so that one number means the same instance on all of them. The caller keeps calls apart: one at a
 * time in a process. Functions marked "all" return on no rank before every rank has called them. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <dmumps_c.h>
#include <mpi.h>

_Static_assert(sizeof(MUMPS_INT) == sizeof(int), "a MUMPS with 32 bit integers is needed");

typedef struct {
    DMUMPS_STRUC_C mumps;
    int *schur;
} Instance;

static Instance **table;
static int places;

static void run(Instance *at, int job) {
    at->mumps.job = job;
    dmumps_c(&at->mumps);
}

/* All: begins MPI. 0, or what went wrong: 1 begun already, 2 refused, 3 only one thread may call it. */
int dpana_ranks_join(int *rank, int *count) {
    int begun = 0, threads = 0;
    MPI_Initialized(&begun);
    if (begun) return 1;
    /* Ranks share cores with each other and with the contact solve: who waits steps aside, and BLAS
     * starts no threads of its own. */
    setenv("OMPI_MCA_mpi_yield_when_idle", "1", 0);
    void (*blas_threads)(int);
    *(void **)&blas_threads = dlsym(RTLD_DEFAULT, "openblas_set_num_threads");
    if (blas_threads) blas_threads(1);
    if (MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &threads) != MPI_SUCCESS) return 2;
    MPI_Comm_rank(MPI_COMM_WORLD, rank);
    MPI_Comm_size(MPI_COMM_WORLD, count);
    return threads < MPI_THREAD_SERIALIZED ? 3 : 0;
}

/* All: ends MPI. */
void dpana_ranks_leave(void) { MPI_Finalize(); }

/* Ends every rank at once. */
void dpana_ranks_abort(void) { MPI_Abort(MPI_COMM_WORLD, 2); }

/* All: numbers of rank 0 to every rank. Who waits sleeps, up to 2 ms at a time. */
void dpana_ranks_tell(int *numbers, int count) {
    MPI_Request request;
    int done = 0;
    struct timespec pause = {0, 1000};
    MPI_Ibcast(numbers, count, MPI_INT, 0, MPI_COMM_WORLD, &request);
    for (MPI_Test(&request, &done, MPI_STATUS_IGNORE); !done; MPI_Test(&request, &done, MPI_STATUS_IGNORE)) {
        nanosleep(&pause, NULL);
        if (pause.tv_nsec < 1000000) pause.tv_nsec *= 2;
    }
}

/* All: the least of a number over the ranks. */
int dpana_ranks_least(int number) {
    int least = number;
    MPI_Allreduce(&number, &least, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    return least;
}

/* All: text of one rank to every rank. */
void dpana_ranks_text(int from, char *text, int length) {
    MPI_Bcast(text, length, MPI_CHAR, from, MPI_COMM_WORLD);
}

/* All: a number of every rank, in `all` on rank 0 alone. */
void dpana_ranks_gather(double number, double *all) {
    MPI_Gather(&number, 1, MPI_DOUBLE, all, 1, MPI_DOUBLE, 0, MPI_COMM_WORLD);
}

/* All: the sum of a number over the ranks of a machine, over the memory of that machine in bytes. */
double dpana_ranks_share_of_memory(double bytes) {
    MPI_Comm machine;
    double sum = bytes;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Allreduce(&bytes, &sum, 1, MPI_DOUBLE, MPI_SUM, machine);
    MPI_Comm_free(&machine);
    return sum / ((double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE));
}

/* All: a new instance for positive definite symmetric matrices; its number, or -1 where there is no memory. */
int dpana_mumps_new(void) {
    int number = 0;
    while (number < places && table[number]) number++;
    if (number == places) {
        Instance **larger = realloc(table, sizeof(*table) * (size_t)(places + 1));
        if (!larger) return -1;
        table = larger;
        table[places++] = NULL;
    }
    Instance *at = calloc(1, sizeof(*at));
    if (!at) return -1;
    at->mumps.comm_fortran = (MUMPS_INT)MPI_Comm_c2f(MPI_COMM_WORLD);
    at->mumps.par = 1;
    at->mumps.sym = 1;
    run(at, -1);
    at->mumps.icntl[0] = at->mumps.icntl[1] = at->mumps.icntl[2] = -1; /* says nothing */
    at->mumps.icntl[15] = 1;                                           /* one OpenMP thread */
    table[number] = at;
    return number;
}

/* All: analysis of the sum of all ranks' entries (from 1, lower triangle), eliminated as they are numbered, the
 * last `schur` not at all. The arrays are kept until the factorisation. INFOG(1). */
int dpana_mumps_analyse(int number, int size, int schur, long long entries, int *rows, int *columns, double *values) {
    Instance *at = table[number];
    DMUMPS_STRUC_C *mumps = &at->mumps;
    int *order = malloc(sizeof(int) * (size_t)(size + 1));
    at->schur = malloc(sizeof(int) * (size_t)(schur + 1));
    if (!order || !at->schur) MPI_Abort(MPI_COMM_WORLD, 2);
    for (int k = 0; k < size; k++) order[k] = k + 1;
    for (int k = 0; k < schur; k++) at->schur[k] = size - schur + k + 1;
    mumps->n = size;
    mumps->nnz_loc = entries;
    mumps->irn_loc = rows;
    mumps->jcn_loc = columns;
    mumps->a_loc = values;
    mumps->perm_in = order;
    mumps->icntl[6] = 1;   /* the order is given */
    mumps->icntl[17] = 3;  /* entries are distributed */
    mumps->icntl[27] = 1;  /* analysis on rank 0 */
    if (schur) {
        mumps->size_schur = schur;
        mumps->listvar_schur = at->schur;
        mumps->icntl[18] = 1; /* Schur complement on rank 0, lower triangle by rows */
    }
    run(at, 1);
    mumps->perm_in = NULL;
    free(order);
    return mumps->infog[0];
}

/* All: factorisation of the values given now, with so many percent of room beyond the estimate; `schur` on
 * rank 0. INFOG(1). */
int dpana_mumps_factorise(int number, int room, double *values, double *schur) {
    DMUMPS_STRUC_C *mumps = &table[number]->mumps;
    mumps->icntl[13] = room;
    mumps->a_loc = values;
    mumps->schur = schur;
    run(table[number], 2);
    mumps->schur = NULL;
    return mumps->infog[0];
}

/* All: a right side on rank 0, in place: ICNTL(26) = 0 solves, 1 reduces onto the Schur complement, 2 expands from
 * there. INFOG(1). */
int dpana_mumps_solve(int number, int way, double *force, double *reduced) {
    DMUMPS_STRUC_C *mumps = &table[number]->mumps;
    mumps->icntl[25] = way;
    mumps->rhs = force;
    mumps->nrhs = 1;
    mumps->lrhs = mumps->n;
    mumps->redrhs = reduced;
    mumps->lredrhs = mumps->size_schur;
    run(table[number], 3);
    mumps->rhs = mumps->redrhs = NULL;
    return mumps->infog[0];
}

/* Forgets the arrays of the entries. */
void dpana_mumps_forget(int number) {
    DMUMPS_STRUC_C *mumps = &table[number]->mumps;
    mumps->irn_loc = mumps->jcn_loc = NULL;
    mumps->a_loc = NULL;
}

/* INFOG(i), or INFO(i) of this rank. */
int dpana_mumps_said(int number, int global, int i) {
    DMUMPS_STRUC_C *mumps = &table[number]->mumps;
    return global ? mumps->infog[i - 1] : mumps->info[i - 1];
}

/* All: frees an instance. */
void dpana_mumps_free(int number) {
    run(table[number], -2);
    free(table[number]->schur);
    free(table[number]);
    table[number] = NULL;
}
