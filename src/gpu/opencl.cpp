// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// The OpenCL backend; no other file calls OpenCL.
#include <fmt/format.h>

#include <map>
#include <mutex>

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <CL/cl_ext.h>

#include "gpu/device_queue.hpp"

namespace tofsmith {

namespace {

template <auto release, typename Object>
DeviceHandle handle_of(Object object) {
  return {object, [](void* made) { release(static_cast<Object>(made)); }};
}
cl_mem memory_of(const DeviceMemory& memory) { return static_cast<cl_mem>(memory.handle.get()); }
cl_kernel kernel_of(const DeviceKernel& kernel) {
  return static_cast<cl_kernel>(kernel.handle.get());
}
cl_command_queue queue_of(const DeviceHandle& handle) {
  return static_cast<cl_command_queue>(handle.get());
}

std::string name_of_error(cl_int error) {
  switch (error) {
    case CL_DEVICE_NOT_AVAILABLE:
      return "CL_DEVICE_NOT_AVAILABLE";
    case CL_COMPILER_NOT_AVAILABLE:
      return "CL_COMPILER_NOT_AVAILABLE";
    case CL_MEM_OBJECT_ALLOCATION_FAILURE:
      return "CL_MEM_OBJECT_ALLOCATION_FAILURE";
    case CL_OUT_OF_RESOURCES:
      return "CL_OUT_OF_RESOURCES";
    case CL_OUT_OF_HOST_MEMORY:
      return "CL_OUT_OF_HOST_MEMORY";
    case CL_BUILD_PROGRAM_FAILURE:
      return "CL_BUILD_PROGRAM_FAILURE";
    case CL_INVALID_BUFFER_SIZE:
      return "CL_INVALID_BUFFER_SIZE";
    default:
      return "unknown OpenCL error";
  }
}

bool is_for_memory(cl_int error) {
  return error == CL_MEM_OBJECT_ALLOCATION_FAILURE || error == CL_OUT_OF_RESOURCES ||
         error == CL_OUT_OF_HOST_MEMORY || error == CL_INVALID_BUFFER_SIZE;
}

std::string place_of(const DeviceInfo& info) { return "device " + info.name; }

void check(cl_int error, const std::string& place, const char* what) {
  if (error == CL_SUCCESS) return;
  const std::string problem = fmt::format("{} failed: {} ({})", what, name_of_error(error), error);
  if (is_for_memory(error)) throw OutOfDeviceMemory(place, problem);
  throw IoError(place, problem);
}

template <typename Get>
std::string text_of(const Get& get) {
  std::size_t size = 0;
  if (get(0, nullptr, &size) != CL_SUCCESS || size == 0) return {};
  std::string text(size, '\0');
  if (get(size, text.data(), nullptr) != CL_SUCCESS) return {};
  text.resize(text.find_last_not_of(std::string_view(" \0", 2)) + 1);
  return text;
}

template <typename Value>
Value number_of(cl_device_id device, cl_device_info what) {
  Value value{};
  clGetDeviceInfo(device, what, sizeof value, &value, nullptr);
  return value;
}

DeviceInfo info_of(cl_platform_id platform, cl_device_id device) {
  const auto text = [&](cl_device_info what) {
    return text_of([&](std::size_t room, void* to, std::size_t* size) {
      return clGetDeviceInfo(device, what, room, to, size);
    });
  };
  DeviceInfo info;
  info.name = text(CL_DEVICE_NAME);
  info.platform = text_of([&](std::size_t room, void* to, std::size_t* size) {
    return clGetPlatformInfo(platform, CL_PLATFORM_NAME, room, to, size);
  });
  info.version = fmt::format("{}, {}", text(CL_DEVICE_VERSION), text(CL_DRIVER_VERSION));
  const auto type = number_of<cl_device_type>(device, CL_DEVICE_TYPE);
  info.kind = (type & CL_DEVICE_TYPE_GPU) != 0   ? DeviceKind::gpu
              : (type & CL_DEVICE_TYPE_CPU) != 0 ? DeviceKind::cpu
                                                 : DeviceKind::other;
  info.memory_bytes = number_of<cl_ulong>(device, CL_DEVICE_GLOBAL_MEM_SIZE);
  info.has_doubles = number_of<cl_device_fp_config>(device, CL_DEVICE_DOUBLE_FP_CONFIG) != 0;
  info.divides_as_processor = (number_of<cl_device_fp_config>(device, CL_DEVICE_SINGLE_FP_CONFIG) &
                               CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
  return info;
}

}  // namespace

struct Device::State {
  State(cl_platform_id platform, cl_device_id id_) : id(id_), info(info_of(platform, id_)) {}

  cl_context context() {
    const std::lock_guard lock(mutex);
    if (!made) {
      cl_int error = CL_SUCCESS;
      made =
          handle_of<clReleaseContext>(clCreateContext(nullptr, 1, &id, nullptr, nullptr, &error));
      check(error, place_of(info), "creating a context");
    }
    return static_cast<cl_context>(made.get());
  }
  cl_program program(std::string_view source, const std::string& options);

  cl_device_id id;
  DeviceInfo info;

 private:
  std::mutex mutex;
  DeviceHandle made = no_handle();  // context, created on first use
  std::map<std::string, DeviceHandle> programs;
};

cl_program Device::State::program(std::string_view source, const std::string& options) {
  const cl_context within = context();
  const std::lock_guard lock(mutex);
  const std::string key = options + '\n' + std::string(source);
  if (const auto found = programs.find(key); found != programs.end())
    return static_cast<cl_program>(found->second.get());
  const char* text = source.data();
  const std::size_t length = source.size();
  cl_int error = CL_SUCCESS;
  const cl_program program = clCreateProgramWithSource(within, 1, &text, &length, &error);
  DeviceHandle handle = handle_of<clReleaseProgram>(program);
  check(error, place_of(info), "loading kernels");
  error = clBuildProgram(program, 1, &id, options.c_str(), nullptr, nullptr);
  if (error != CL_SUCCESS) {
    const std::string log = text_of([&](std::size_t room, void* to, std::size_t* size) {
      return clGetProgramBuildInfo(program, id, CL_PROGRAM_BUILD_LOG, room, to, size);
    });
    throw IoError(place_of(info),
                  fmt::format("compiling kernels failed: {} ({}); pocl requires a writable folder "
                              "for kernels, POCL_CACHE_DIR. Compiler output: {}",
                              name_of_error(error), error, log.empty() ? "nothing" : log));
  }
  programs.emplace(key, std::move(handle));
  return program;
}

std::vector<Device> Device::all() {
  constexpr const char* place = "OpenCL";
  cl_uint count = 0;
  const cl_int error = clGetPlatformIDs(0, nullptr, &count);
  if (error == CL_PLATFORM_NOT_FOUND_KHR || count == 0) return {};
  check(error, place, "querying platforms");
  std::vector<cl_platform_id> platforms(count);
  check(clGetPlatformIDs(count, platforms.data(), nullptr), place, "querying platforms");
  std::vector<Device> devices;
  for (const cl_platform_id platform : platforms) {
    // Skip drivers that have lost their devices.
    if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count) != CL_SUCCESS) continue;
    std::vector<cl_device_id> ids(count);
    if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, ids.data(), nullptr) != CL_SUCCESS)
      continue;
    for (const cl_device_id id : ids)
      if (number_of<cl_bool>(id, CL_DEVICE_AVAILABLE) == CL_TRUE)
        devices.emplace_back(std::make_shared<State>(platform, id));
  }
  return devices;
}

const DeviceInfo& Device::info() const { return state_->info; }

DeviceQueue::DeviceQueue(const Device& device) : device_(device) {
  cl_int error = CL_SUCCESS;
  handle_ = handle_of<clReleaseCommandQueue>(
      clCreateCommandQueue(device.state().context(), device.state().id, 0, &error));
  check(error, place_of(device.info()), "creating a queue");
}

DeviceMemory DeviceQueue::allocate(std::size_t bytes) const {
  Device::State& state = device_.state();
  // Some drivers detect this when the memory is used, and abort.
  if (bytes > number_of<cl_ulong>(state.id, CL_DEVICE_MAX_MEM_ALLOC_SIZE))
    check(CL_INVALID_BUFFER_SIZE, place_of(state.info), "allocating memory");
  cl_int error = CL_SUCCESS;
  DeviceMemory memory{handle_of<clReleaseMemObject>(clCreateBuffer(
                          state.context(), CL_MEM_READ_WRITE, bytes, nullptr, &error)),
                      bytes};
  check(error, place_of(state.info), "allocating memory");
  return memory;
}

void DeviceQueue::upload(const void* from, std::size_t bytes, const DeviceMemory& to) const {
  check(clEnqueueWriteBuffer(queue_of(handle_), memory_of(to), CL_TRUE, 0, bytes, from, 0, nullptr,
                             nullptr),
        place_of(device_.info()), "copying to the device");
}

void DeviceQueue::download(const DeviceMemory& from, std::size_t bytes, void* to) const {
  check(clEnqueueReadBuffer(queue_of(handle_), memory_of(from), CL_TRUE, 0, bytes, to, 0, nullptr,
                            nullptr),
        place_of(device_.info()), "copying from the device");
}

void DeviceQueue::copy(const DeviceMemory& from, std::size_t first, const DeviceMemory& to,
                       std::size_t first_there, std::size_t bytes) const {
  check(clEnqueueCopyBuffer(queue_of(handle_), memory_of(from), memory_of(to), first, first_there,
                            bytes, 0, nullptr, nullptr),
        place_of(device_.info()), "copying on the device");
}

void DeviceQueue::clear(const DeviceMemory& memory) const {
  constexpr cl_uchar zero = 0;
  check(clEnqueueFillBuffer(queue_of(handle_), memory_of(memory), &zero, sizeof zero, 0,
                            memory.bytes, 0, nullptr, nullptr),
        place_of(device_.info()), "clearing memory");
}

DeviceKernel DeviceQueue::kernel(std::string_view source, const std::string& options,
                                 const char* name) const {
  const DeviceInfo& info = device_.info();
  std::string all = "-cl-std=CL1.2 " + options;
  if (info.divides_as_processor) all += " -cl-fp32-correctly-rounded-divide-sqrt";
  const cl_program program = device_.state().program(source, all);
  cl_int error = CL_SUCCESS;
  DeviceKernel kernel{handle_of<clReleaseKernel>(clCreateKernel(program, name, &error))};
  check(error, place_of(device_.info()), "creating a kernel");
  return kernel;
}

void DeviceQueue::set(const DeviceKernel& kernel, unsigned at, const DeviceMemory* memory) const {
  const cl_mem object = memory ? memory_of(*memory) : nullptr;
  set_bytes(kernel, at, static_cast<const void*>(&object), sizeof(cl_mem));
}

void DeviceQueue::set_bytes(const DeviceKernel& kernel, unsigned at, const void* value,
                            std::size_t bytes) const {
  check(clSetKernelArg(kernel_of(kernel), at, bytes, value), place_of(device_.info()),
        "setting an argument of a kernel");
}

void DeviceQueue::start(const DeviceKernel& kernel, const Extent& items,
                        const Extent& group) const {
  Extent whole = items;
  for (std::size_t i = 0; i < whole.size(); ++i)
    whole[i] = (items[i] + group[i] - 1) / group[i] * group[i];
  const cl_uint dimensions = group[1] > 1 ? 2 : 1;
  check(clEnqueueNDRangeKernel(queue_of(handle_), kernel_of(kernel), dimensions, nullptr,
                               whole.data(), group.data(), 0, nullptr, nullptr),
        place_of(device_.info()), "starting a kernel");
}

DeviceMark DeviceQueue::mark() const {
  cl_event event = nullptr;
  const cl_int error = clEnqueueMarkerWithWaitList(queue_of(handle_), 0, nullptr, &event);
  DeviceMark mark{handle_of<clReleaseEvent>(event)};
  check(error, place_of(device_.info()), "inserting a marker");
  flush();  // otherwise followers may wait forever
  return mark;
}

void DeviceQueue::follow(const DeviceMark& mark) const {
  const auto event = static_cast<cl_event>(mark.handle.get());
  check(clEnqueueBarrierWithWaitList(queue_of(handle_), 1, &event, nullptr),
        place_of(device_.info()), "inserting a barrier");
}

void DeviceQueue::flush() const {
  check(clFlush(queue_of(handle_)), place_of(device_.info()), "starting kernels");
}

void DeviceQueue::finish() const {
  check(clFinish(queue_of(handle_)), place_of(device_.info()), "waiting for kernels");
}

}  // namespace tofsmith
