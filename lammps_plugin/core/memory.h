// Arrays as long as the fluid, in huge pages: the processor then looks up few addresses.

#pragma once

#include <cstdlib>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace mpc {

constexpr std::size_t CACHE_LINE = 64;    // bytes

template <class T> struct HugePages {
  using value_type = T;

  HugePages() = default;
  template <class U> HugePages(const HugePages<U> &) {}

  T *allocate(std::size_t count)
  {
    constexpr std::size_t page = std::size_t{1} << 21;
    const std::size_t bytes = count * sizeof(T);
    const std::size_t alignment = bytes < page ? CACHE_LINE : page;
    const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
    void *memory = std::aligned_alloc(alignment, rounded);
    if (!memory) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    if (alignment == page) madvise(memory, rounded, MADV_HUGEPAGE);    // a wish: it may fail
#endif
    return static_cast<T *>(memory);
  }

  void deallocate(T *memory, std::size_t) { std::free(memory); }

  template <class U> bool operator==(const HugePages<U> &) const { return true; }
  template <class U> bool operator!=(const HugePages<U> &) const { return false; }
};

template <class T> using Array = std::vector<T, HugePages<T>>;

}    // namespace mpc
