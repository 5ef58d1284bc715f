// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#if __has_include(<CL/cl.h>)
#include "watched_opencl.hpp"

#include <dlfcn.h>

namespace {

template <typename Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

#define REAL(function) real<decltype(function)>(#function)

extern "C" {

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                              const size_t* offset, const size_t* global, const size_t* local,
                              cl_uint waits, const cl_event* list, cl_event* event) {
  if (const cl_int error = tofsmith::failure.next()) return error;
  return REAL(clEnqueueNDRangeKernel)(queue, kernel, dimensions, offset, global, local, waits, list,
                                      event);
}

cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem memory, cl_bool blocks, size_t offset,
                           size_t bytes, void* to, cl_uint waits, const cl_event* list,
                           cl_event* event) {
  if (const cl_int error = tofsmith::failure.next()) return error;
  return REAL(clEnqueueReadBuffer)(queue, memory, blocks, offset, bytes, to, waits, list, event);
}

cl_int clEnqueueWriteBuffer(cl_command_queue queue, cl_mem memory, cl_bool blocks, size_t offset,
                            size_t bytes, const void* from, cl_uint waits, const cl_event* list,
                            cl_event* event) {
  if (const cl_int error = tofsmith::failure.next()) return error;
  return REAL(clEnqueueWriteBuffer)(queue, memory, blocks, offset, bytes, from, waits, list, event);
}

cl_int clEnqueueFillBuffer(cl_command_queue queue, cl_mem memory, const void* pattern,
                           size_t pattern_bytes, size_t offset, size_t bytes, cl_uint waits,
                           const cl_event* list, cl_event* event) {
  if (const cl_int error = tofsmith::failure.next()) return error;
  return REAL(clEnqueueFillBuffer)(queue, memory, pattern, pattern_bytes, offset, bytes, waits,
                                   list, event);
}

cl_int clEnqueueCopyBuffer(cl_command_queue queue, cl_mem from, cl_mem to, size_t from_offset,
                           size_t to_offset, size_t bytes, cl_uint waits, const cl_event* list,
                           cl_event* event) {
  if (const cl_int error = tofsmith::failure.next()) return error;
  return REAL(clEnqueueCopyBuffer)(queue, from, to, from_offset, to_offset, bytes, waits, list,
                                   event);
}

cl_int clFlush(cl_command_queue queue) {
  if (const cl_int error = tofsmith::failure.next()) return error;
  return REAL(clFlush)(queue);
}

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t bytes, void* from,
                      cl_int* error) {
  *error = tofsmith::failure.next();
  return *error ? nullptr : REAL(clCreateBuffer)(context, flags, bytes, from, error);
}

cl_int clEnqueueMarkerWithWaitList(cl_command_queue queue, cl_uint waits, const cl_event* list,
                                   cl_event* event) {
  if (const cl_int error = tofsmith::failure.next()) return error;
  return REAL(clEnqueueMarkerWithWaitList)(queue, waits, list, event);
}

cl_int clEnqueueBarrierWithWaitList(cl_command_queue queue, cl_uint waits, const cl_event* list,
                                    cl_event* event) {
  if (const cl_int error = tofsmith::failure.next()) return error;
  return REAL(clEnqueueBarrierWithWaitList)(queue, waits, list, event);
}

cl_int clFinish(cl_command_queue queue) {
  if (const cl_int error = tofsmith::failure.next()) return error;
  return REAL(clFinish)(queue);
}

}  // extern "C"
#endif
